// Tests instances that are sealed: they have fewer BLASes and show the same, until an edit unseals them.
#include "context/vulkan_table.h"
#include "render/edited_scene.h"
#include "render/replacement.h"
#include "scene/scene_store.h"
#include "support/must.h"

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

// The device's driver gets triangles and instances as they are, so that BLASes may have several primitives.
EditedSceneOptions joiningOptions() {
    EditedSceneOptions options;
    options.traversalOrder = SceneView::TraversalOrder::Input;
    return options;
}

// A scene with a mesh of two primitives, which two instances have.
class Pair {
public:
    explicit Pair(EditedSceneOptions options = joiningOptions(), std::array<std::size_t, 2> kinds = {1, 2})
        : edited(std::move(options)), bytes(edited.gpuScene().allocatedBytes()) {
        EditedScene::Mesh added{{}, 2, {kinds[0], kinds[1]}};
        std::vector<SceneEditor::EditedPrimitive> primitives;
        for (std::size_t i = 0; i < kinds.size(); ++i) {
            primitives.push_back({edited.primitive(2, i), edited.materials[kinds[i]].handle});
        }
        added.handle = must(editor().addMesh(primitives)).mesh;
        edited.meshes.push_back(added);
        for (const float x : {-0.7F, 0.8F}) {
            EditedScene::Instance instance;
            instance.mesh = edited.meshes.size() - 1;
            instance.objectToWorld = {1, 0, 0, x, 0, 1, 0, 0.1F * x, 0, 0, 1, -2.5F};
            instance.handle = must(editor().addInstance({added.handle, instance.objectToWorld})).instance;
            edited.instances.push_back(instance);
        }
        edited.frame();
        edited.drain();
    }
    SceneEditor& editor() {
        return edited.editor();
    }
    SceneStore& store() {
        return *edited.gpuScene().state().store;
    }
    EditedScene::Instance& instance(std::size_t which) {
        return edited.instances[edited.instances.size() - 2 + which];
    }
    const StoredMesh& mesh() {
        return *store().meshes.find(edited.meshes.back().handle);
    }
    bool isSealed(std::size_t which) {
        return store().instanceSlots.find(instance(which).handle)->form != nullptr;
    }
    std::uint32_t places() {
        return store().topLevel.records().count();
    }
    void seal() {
        EXPECT_TRUE(editor().seal(std::array{instance(0).handle, instance(1).handle}));
        edited.frame();
    }
    void setMaterial(std::size_t which, std::size_t primitive, std::optional<std::size_t> material) {
        instance(which).materials.resize(2);
        instance(which).materials[primitive] = material;
        EXPECT_TRUE(
            editor().setInstanceMaterial(instance(which).handle, static_cast<std::uint32_t>(primitive),
                                         material ? edited.materials[*material].handle : MaterialHandle{}));
        edited.frame();
    }

    EditedScene edited;
    std::uint64_t bytes = 0;  // before the mesh was added
};

constexpr std::size_t kUnlit = 4;
constexpr std::size_t kFence = 5;  // masked and double-sided

TEST(LiveEditSeal, InstancesShareOneBlasOfAllPrimitives) {
    Pair pair;
    const std::uint32_t before = pair.places();
    const std::uint32_t blases = pair.edited.gpuScene().statistics().blasCount;
    pair.seal();
    EXPECT_TRUE(pair.isSealed(0) && pair.isSealed(1));
    EXPECT_EQ(pair.mesh().forms.size(), 1U);
    EXPECT_FALSE(pair.mesh().isOpen);
    EXPECT_EQ(pair.places(), before - 2);
    EXPECT_EQ(pair.edited.gpuScene().statistics().blasCount, blases - 1);
    pair.edited.expectSameAsFresh("sealed");
    pair.instance(0).objectToWorld[3] -= 0.2F;
    ASSERT_TRUE(pair.editor().moveInstance(pair.instance(0).handle, pair.instance(0).objectToWorld));
    ASSERT_TRUE(pair.editor().showInstance(pair.instance(1).handle, false));
    pair.instance(1).visible = false;
    pair.edited.expectSameAsFresh("one moved, one hidden");
    EXPECT_EQ(pair.places(), before - 3);
    ASSERT_TRUE(pair.editor().showInstance(pair.instance(1).handle, true));
    pair.instance(1).visible = true;
    pair.setMaterial(1, 0, kUnlit);
    pair.edited.expectSameAsFresh("another material that is seen alike");
    EXPECT_TRUE(pair.isSealed(0) && pair.isSealed(1));
}

TEST(LiveEditSeal, AnEditUnsealsItsInstanceAlone) {
    Pair pair;
    pair.seal();
    const std::uint32_t sealed = pair.places();
    pair.setMaterial(0, 1, kFence);
    EXPECT_FALSE(pair.isSealed(0));
    EXPECT_TRUE(pair.isSealed(1));
    EXPECT_TRUE(pair.mesh().isOpen);
    EXPECT_EQ(pair.places(), sealed + 1);
    pair.edited.expectSameAsFresh("one is unsealed");
    pair.seal();
    EXPECT_FALSE(pair.isSealed(0)) << "its primitives are not seen alike";
    pair.setMaterial(0, 0, kFence);
    pair.seal();
    EXPECT_TRUE(pair.isSealed(0)) << "both are masked";
    EXPECT_EQ(pair.mesh().forms.size(), 1U) << "which the TLAS says of the same BLAS";
    EXPECT_FALSE(pair.mesh().isOpen);
    pair.edited.expectSameAsFresh("sealed again");
    EXPECT_EQ(pair.places(), sealed);
    ASSERT_TRUE(pair.editor().setInstanceMesh(pair.instance(0).handle, pair.edited.meshes[0].handle));
    pair.instance(0).mesh = 0;
    pair.instance(0).materials.clear();
    pair.edited.expectSameAsFresh("another mesh");
    EXPECT_FALSE(pair.isSealed(0));
    EXPECT_TRUE(pair.isSealed(1));
}

TEST(LiveEditSeal, AMaterialOfTheMeshUnsealsAllOfThem) {
    Pair pair;
    pair.seal();
    pair.edited.meshes.back().materials[0] = kFence;
    ASSERT_TRUE(pair.editor().setMeshMaterial(pair.edited.meshes.back().handle, 0,
                                              pair.edited.materials[kFence].handle));
    pair.edited.expectSameAsFresh("unsealed");
    EXPECT_FALSE(pair.isSealed(0) || pair.isSealed(1));
    EXPECT_TRUE(pair.mesh().forms.empty());
    EXPECT_TRUE(pair.mesh().isOpen);
    EXPECT_EQ(pair.store().scene.joinedBlases, 0U);
}

TEST(LiveEditSeal, MemoryReturns) {
    Pair pair;
    pair.seal();
    pair.setMaterial(0, 1, kFence);
    pair.seal();
    while (pair.edited.instances.size() > 2) {
        ASSERT_TRUE(pair.editor().removeInstance(pair.edited.instances.back().handle));
        pair.edited.instances.pop_back();
    }
    ASSERT_TRUE(pair.editor().removeMesh(pair.edited.meshes.back().handle));
    pair.edited.meshes.pop_back();
    pair.editor().trim();
    pair.edited.expectSameAsFresh("removed");
    EXPECT_EQ(pair.store().building.bytes(), 0U) << "all BLASes are compacted";
    EXPECT_EQ(pair.edited.gpuScene().allocatedBytes(), pair.bytes);
}

// A mesh that an edit adds is as small as one of an upload, once the device has built it.
TEST(LiveEditSeal, BlasesOfEditsAreCompacted) {
    Pair pair;
    EXPECT_GT(pair.store().building.bytes(), 0U);
    pair.edited.frame();
    pair.edited.drain();
    EXPECT_EQ(pair.store().building.bytes(), 0U);
    EXPECT_TRUE(pair.store().compactions.empty());
    pair.seal();
    EXPECT_GT(pair.store().building.bytes(), 0U);
    pair.edited.drain();
    pair.edited.frame();
    pair.edited.drain();
    EXPECT_EQ(pair.store().building.bytes(), 0U);
    pair.edited.expectSameAsFresh("compacted");
}

// The BLASes of single primitives are not even made.
TEST(LiveEditSeal, AnUploadMayBeginSealed) {
    gltf::Scene scene = catalogueScene();
    const EditedSceneOptions options;
    const LoadedScene loaded(scene, options.settings);
    session::SceneViewData data = session::makeSceneView(scene);
    for (std::size_t i = 0; i < data.instances.size(); ++i) {
        data.instances[i].objectToWorld[3] += 0.1F * static_cast<float>(i);
        data.instances[i].objectToWorld[11] -= 2.0F + 0.01F * static_cast<float>(i);
    }
    SceneView view = data.view();
    view.traversalOrder = SceneView::TraversalOrder::Input;
    const auto still = uploadScene(loaded.package(), view);
    view.editable = true;
    const auto open = uploadScene(loaded.package(), view);
    view.sealed = true;
    const auto sealed = uploadScene(loaded.package(), view);
    RendererOptions renderer = options.renderer;
    renderer.width = options.width;
    renderer.height = options.height;
    const FrameOptions frame = defaultSetup(scene, options.width, options.height).frame;
    const LinearImage expected = drawn(*makeRenderer(loaded.package(), *still, renderer), frame);
    EXPECT_EQ(drawn(*makeRenderer(loaded.package(), *open, renderer), frame).pixels, expected.pixels);
    EXPECT_EQ(drawn(*makeRenderer(loaded.package(), *sealed, renderer), frame).pixels, expected.pixels);
    // Of the meshes with two primitives, those with a fence and something else have two BLASes.
    constexpr std::uint32_t kSingle = 2 * kKinds;
    constexpr std::uint32_t kMixed = 2 * (kKinds - 1);
    EXPECT_EQ(open->statistics().blasCount, kSingle + 2 * kKinds * kKinds);
    EXPECT_EQ(sealed->statistics().blasCount, kSingle + kKinds * kKinds + kMixed);
    EXPECT_EQ(sealed->state().store->building.bytes(), 0U);
}

// Its shader binding table finds the shader of a hit by the instance of the TLAS.
TEST(LiveEditSeal, AStrategyWithItsOwnPipelineKeepsPrimitivesApart) {
    if ((sharedContext().handles().tracers & package::kTracerRayPipeline) == 0) {
        GTEST_SKIP() << "the device has no ray tracing pipelines";
    }
    EditedSceneOptions options(package::kStrategyHitShaders, package::kTracerRayPipeline);
    options.traversalOrder = SceneView::TraversalOrder::Input;
    {
        Pair pair(options);
        pair.seal();
        EXPECT_FALSE(pair.isSealed(0) || pair.isSealed(1));
        pair.edited.expectSameAsFresh("as before");
    }
    // Beside a renderer that does not mind.
    Pair pair;
    pair.seal();
    ASSERT_GT(pair.store().scene.joinedBlases, 0U);
    const std::shared_ptr<const Package> package = packageOf(pair.edited.original, options.settings);
    options.renderer.width = options.width;
    options.renderer.height = options.height;
    const FrameOptions frame = defaultSetup(pair.edited.scene, options.width, options.height).frame;
    const auto other = makeRenderer(*package, pair.edited.gpuScene(), options.renderer);
    const Diagnostic refused = mustFail(other->render(frame));
    EXPECT_EQ(refused.id, "scene-package");
    EXPECT_NE(refused.hint.find("SceneEditor::record()"), std::string::npos);
    pair.edited.frame();
    pair.edited.drain();
    EXPECT_EQ(pair.store().scene.joinedBlases, 0U);
    EXPECT_FALSE(pair.isSealed(0) || pair.isSealed(1));
    const LinearImage apart = drawn(*other, frame);
    pair.edited.expectSameAsFresh("apart");
    pair.seal();
    EXPECT_EQ(pair.store().scene.joinedBlases, 0U) << "the other renderer is still there";
    EXPECT_EQ(drawn(*other, frame).pixels, apart.pixels);
}

// Lets the making of acceleration structures fail, after some that succeed.
class NoStructures {
public:
    explicit NoStructures(int after) {
        left_ = after;
        real_ = sharedContext().state().vk.CreateAccelerationStructureKHR;
        sharedContext().state().vk.CreateAccelerationStructureKHR =
            [](VkDevice device, const VkAccelerationStructureCreateInfoKHR* info,
               const VkAllocationCallbacks* callbacks, VkAccelerationStructureKHR* made) {
                return left_-- > 0 ? real_(device, info, callbacks, made) : VK_ERROR_OUT_OF_DEVICE_MEMORY;
            };
    }
    ~NoStructures() {
        sharedContext().state().vk.CreateAccelerationStructureKHR = real_;
    }
    NoStructures(const NoStructures&) = delete;
    NoStructures& operator=(const NoStructures&) = delete;

private:
    static inline int left_ = 0;
    static inline PFN_vkCreateAccelerationStructureKHR real_ = nullptr;
};

TEST(LiveEditSeal, WithoutMemoryTheEditsWait) {
    Pair pair;
    pair.edited.frame();
    pair.edited.drain();
    const std::uint32_t blases = pair.edited.gpuScene().statistics().blasCount;
    const auto expectWaits = [&](int after) {
        const NoStructures none(after);
        const Status status = pair.editor().record(VK_NULL_HANDLE, ~std::uint64_t{0});
        ASSERT_FALSE(status);
        EXPECT_EQ(status.error().kind, ErrorKind::OutOfDeviceMemory);
    };
    EXPECT_TRUE(pair.editor().seal(std::array{pair.instance(0).handle, pair.instance(1).handle}));
    expectWaits(0);
    EXPECT_FALSE(pair.isSealed(0) || pair.isSealed(1));
    EXPECT_EQ(pair.edited.gpuScene().statistics().blasCount, blases);
    pair.edited.expectSameAsFresh("sealed later");
    EXPECT_TRUE(pair.isSealed(0) && pair.isSealed(1));
    EXPECT_EQ(pair.edited.gpuScene().statistics().blasCount, blases - 1);
    pair.instance(0).materials = {std::nullopt, kFence};
    ASSERT_TRUE(
        pair.editor().setInstanceMaterial(pair.instance(0).handle, 1, pair.edited.materials[kFence].handle));
    expectWaits(0);
    expectWaits(1);
    EXPECT_EQ(pair.edited.gpuScene().statistics().blasCount, blases - 1);
    pair.edited.expectSameAsFresh("unsealed later");
    EXPECT_EQ(pair.edited.gpuScene().statistics().blasCount, blases + 1);
}

TEST(LiveEditSeal, UnknownInstancesAreRefused) {
    Pair pair;
    const std::array handles{pair.instance(0).handle, InstanceHandle{}};
    const Status sealed = pair.editor().seal(handles);
    ASSERT_FALSE(sealed);
    EXPECT_EQ(sealed.error().id, "scene-edit-handle");
    EXPECT_TRUE(pair.store().sealing.empty());
}

}  // namespace
}  // namespace glint::testing

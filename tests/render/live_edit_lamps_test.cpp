// Edits of emissive triangles in packages in which these are lights.
#include "render/edited_scene.h"
#include "render/scene_builder.h"
#include "scene/gpu_scene_state.h"
#include "scene/scene_store.h"
#include "support/must.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

// In front of the tent, which it shines at.
constexpr std::array<float, 12> kAbove{-1, 0, 0, -0.4F, 0, 1, 0, 0.4F, 0, 0, -1, -1.3F};
constexpr std::array<float, 12> kAside{-1, 0, 0, 0.9F, 0, 1, 0, 0.3F, 0, 0, -1, -1.6F};

double sumOf(const LinearImage& image) {
    double sum = 0.0;
    for (const auto& pixel : image.pixels) {
        sum += pixel[0] + pixel[1] + pixel[2];
    }
    return sum;
}

class LampEdits {
public:
    explicit LampEdits(const EditedSceneOptions& options) : edited(options) {
        edited.expectSameAsFresh("as uploaded");
    }

    // Adds a quad that shines.
    EditedScene::Instance& addLamp() {
        const SceneEditor::EditedPrimitive primitive{edited.primitive(0, 0), edited.materials[1].handle};
        const Result<SceneEditor::AddedMesh> mesh = edited.editor().addMesh(std::span(&primitive, 1));
        EXPECT_TRUE(mesh) << (mesh ? "" : toString(mesh.error()));
        edited.meshes.push_back({mesh->mesh, 0, {1}, false});
        const Result<SceneEditor::AddedInstance> instance = edited.editor().addInstance({mesh->mesh, kAbove});
        EXPECT_TRUE(instance) << (instance ? "" : toString(instance.error()));
        edited.instances.push_back({instance->instance, edited.meshes.size() - 1, {}, kAbove, true, false});
        return edited.instances.back();
    }

    void removeLamp() {
        EXPECT_TRUE(edited.editor().removeInstance(edited.instances.back().handle));
        EXPECT_TRUE(edited.editor().removeMesh(edited.meshes.back().handle));
        edited.instances.pop_back();
        edited.meshes.pop_back();
    }

    void setEmission(std::uint32_t kind, float strength) {
        edited.scene.materials[kind]["emissiveFactor"] = {strength, strength, strength};
        EXPECT_TRUE(
            edited.editor().setMaterialValues(edited.materials[kind].handle, edited.source(kind).record));
    }

    std::uint32_t emitters() {
        return edited.gpuScene().state().store->counts.emitters;
    }
    // The triangles in the hierarchy that are not dark.
    std::size_t shining() {
        const std::vector<gpu::LightNode>& nodes = edited.gpuScene().state().store->lightTree.nodes;
        return static_cast<std::size_t>(std::ranges::count_if(nodes, [](const gpu::LightNode& node) {
            return (node.next & gpu::kLightEmitter) != 0 && (node.next & gpu::kLightLeaf) != 0 &&
                   node.intensity > 0.0F;
        }));
    }

    EditedScene edited;
};

class LiveEditLamps : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        lamps_ = new LampEdits(EditedSceneOptions::withLamps(2));
    }
    static void TearDownTestSuite() {
        delete lamps_;
    }
    void SetUp() override {}
    static EditedScene& edited() {
        return lamps_->edited;
    }
    static SceneEditor& editor() {
        return edited().editor();
    }
    static inline LampEdits* lamps_ = nullptr;
};

TEST_F(LiveEditLamps, ALampMovesHidesAndGivesItsMemoryBack) {
    const std::uint64_t allocated = edited().gpuScene().allocatedBytes();
    const std::uint32_t before = lamps_->emitters();
    const LinearImage dark = edited().picture();
    EditedScene::Instance& lamp = lamps_->addLamp();
    edited().expectSameAsFresh("with a lamp");
    EXPECT_EQ(lamps_->emitters(), before + 2);
    const LinearImage lit = edited().picture();
    EXPECT_NE(lit.pixels, dark.pixels);
    ASSERT_TRUE(editor().moveInstance(lamp.handle, kAside));
    lamp.objectToWorld = kAside;
    edited().expectSameAsFresh("moved");
    ASSERT_TRUE(editor().showInstance(lamp.handle, false));
    lamp.visible = false;
    edited().expectSameAsFresh("hidden");
    EXPECT_EQ(lamps_->emitters(), before);
    ASSERT_TRUE(editor().showInstance(lamp.handle, true));
    lamp.visible = true;
    edited().expectSameAsFresh("shown");
    lamps_->removeLamp();
    edited().expectSameAsFresh("removed");
    EXPECT_EQ(lamps_->emitters(), before);
    EXPECT_EQ(edited().picture().pixels, dark.pixels);
    editor().trim();
    edited().frame();
    edited().drain();
    EXPECT_EQ(edited().gpuScene().allocatedBytes(), allocated);
}

TEST_F(LiveEditLamps, AMaterialGoesDarkAndBrightAgain) {
    lamps_->addLamp();
    edited().frame();
    const std::size_t bright = lamps_->shining();
    lamps_->setEmission(1, 0.0F);
    edited().expectSameAsFresh("dark");
    EXPECT_EQ(lamps_->shining(), bright - 2);
    lamps_->setEmission(1, 5.0F);
    edited().expectSameAsFresh("bright");
    EXPECT_EQ(lamps_->shining(), bright);
    lamps_->removeLamp();
    edited().expectSameAsFresh("removed");
}

// The material of a variant makes an instance a light, and its own makes it none.
TEST_F(LiveEditLamps, AVariantIsALight) {
    const std::uint32_t before = lamps_->emitters();
    const std::uint32_t floorTriangles = 2;
    ASSERT_TRUE(editor().setInstanceMaterial(edited().instances[0].handle, 0, edited().materials[1].handle));
    edited().instances[0].materials = {1};
    edited().expectSameAsFresh("the floor shines");
    EXPECT_EQ(lamps_->emitters(), before + floorTriangles);
    ASSERT_TRUE(editor().setInstanceMaterial(edited().instances[0].handle, 0, {}));
    edited().instances[0].materials = {std::nullopt};
    edited().expectSameAsFresh("the floor mirrors");
    EXPECT_EQ(lamps_->emitters(), before);
}

// The triangles of the tent show parts of the texture.
TEST_F(LiveEditLamps, AnotherTextureIsBrightElsewhere) {
    EditedScene::Texture& texture = edited().textures.back();
    const EditedScene::Texture original = texture;
    const std::size_t lit = lamps_->shining();
    texture.width = texture.height = 300;
    texture.pixels.assign(std::size_t{4} * 300 * 300, 0);
    ASSERT_TRUE(editor().replaceTexture(texture.handle, texture.view()));
    edited().expectSameAsFresh("black");
    EXPECT_EQ(lamps_->shining(), 0U);
    std::fill_n(texture.pixels.end() - 4 * 300 * 20, 4 * 300 * 20, std::uint8_t{250});
    ASSERT_TRUE(editor().replaceTexture(texture.handle, texture.view()));
    edited().expectSameAsFresh("bright below");
    EXPECT_GT(lamps_->shining(), 0U);
    texture = original;
    ASSERT_TRUE(editor().replaceTexture(texture.handle, texture.view()));
    edited().expectSameAsFresh("as before");
    EXPECT_EQ(lamps_->shining(), lit);
}

std::vector<std::uint8_t> bytesOf(const std::vector<gpu::LightNode>& nodes) {
    const auto* const first = reinterpret_cast<const std::uint8_t*>(nodes.data());
    return {first, first + nodes.size() * sizeof nodes[0]};
}

// Compares the hierarchy and the records with those of a refit of all lights.
void expectRefitted(const SceneStore& store, const std::string& what) {
    ASSERT_TRUE(store.lightTree.refits) << what << ": the hierarchy was built anew";
    std::vector<gpu::LightRecord> lights;
    for (std::uint32_t i = 0; i < store.lights.count(); ++i) {
        lights.push_back(store.lights.read<gpu::LightRecord>(i));
    }
    const std::vector<EmitterBounds> bounds = store.emitters.boundsAt([&](std::uint32_t number) {
        return poseOf(store, *store.instanceSlots.find(store.numberedEmitters[number]));
    });
    LightTree all = store.lightTree;
    refitLightTree(all, lights, bounds);
    EXPECT_EQ(bytesOf(store.lightTree.nodes), bytesOf(all.nodes)) << what;
    const std::span<const std::uint8_t> records = store.lightNodes.at({0, store.lightNodes.count()});
    EXPECT_EQ(std::vector<std::uint8_t>(records.begin(), records.end()), bytesOf(all.nodes)) << what;
    for (std::uint32_t i = 0; i < bounds.size(); ++i) {
        const std::uint32_t leaf = bounds[i].intensity > 0.0 ? all.refits->emitterLeaves[i] : gpu::kNoEmitter;
        EXPECT_EQ(store.emitterRecords.read<gpu::EmitterRecord>(i).leaf, leaf) << what << ", triangle " << i;
    }
}

// One of ten lamps is few enough not to visit the others.
TEST_F(LiveEditLamps, LampsChangeTheirPartOfTheHierarchy) {
    for (int i = 0; i < 10; ++i) {
        lamps_->addLamp();
    }
    const SceneStore& store = *edited().gpuScene().state().store;
    const auto expectAfter = [&](const char* what, const Status& status) {
        EXPECT_TRUE(status) << what;
        edited().frame();
        expectRefitted(store, what);
    };
    edited().frame();
    ASSERT_GT(store.lightTree.nodes.size(), 16U) << "a lamp of two triangles is not few";
    const MaterialHandle paint = edited().materials[1].handle;
    EditedScene::Instance& lamp = edited().instances.back();
    expectAfter("all are visited at first", editor().moveInstance(lamp.handle, kAside));
    lamp.objectToWorld = kAside;
    expectAfter("moved back", editor().moveInstance(lamp.handle, kAbove));
    lamp.objectToWorld = kAbove;
    expectAfter("hidden", editor().showInstance(lamp.handle, false));
    expectAfter("moved while it is hidden", editor().moveInstance(lamp.handle, kAside));
    lamp.objectToWorld = kAside;
    expectAfter("shown", editor().showInstance(lamp.handle, true));
    edited().scene.materials[1]["emissiveFactor"] = {7.0F, 6.0F, 5.0F};
    expectAfter("brighter", editor().setMaterialValues(paint, edited().source(1).record));
    edited().scene.materials[1]["emissiveFactor"] = {0.0F, 0.0F, 0.0F};
    expectAfter("dark", editor().setMaterialValues(paint, edited().source(1).record));
    edited().scene.materials[1]["emissiveFactor"] = {4.0F, 3.0F, 2.0F};
    expectAfter("as before", editor().setMaterialValues(paint, edited().source(1).record));
    EditedScene::Light& light = edited().lights.front();
    light.view.intensity = {0.5F, 0.4F, 0.3F};
    expectAfter("a light apart", editor().setLight(light.handle, light.view));
    edited().expectSameAsFresh("trimmed");
    EXPECT_FALSE(store.lightTree.refits);
    while (edited().instances.size() > 2) {
        lamps_->removeLamp();
    }
    edited().expectSameAsFresh("removed");
}

// An edit that concerns no light leaves the hierarchy alone.
TEST_F(LiveEditLamps, OtherEditsLeaveTheHierarchyAlone) {
    edited().frame();
    const SceneStore& store = *edited().gpuScene().state().store;
    EditedScene::Instance& floor = edited().instances[0];
    floor.objectToWorld[7] -= 0.1F;
    ASSERT_TRUE(editor().moveInstance(floor.handle, floor.objectToWorld));
    edited().scene.materials[1]["baseColorFactor"] = {0.2F, 0.3F, 0.4F, 1.0F};
    edited().scene.materials[3]["roughnessFactor"] = 0.7F;
    for (const std::uint32_t kind : {1U, 3U}) {
        ASSERT_TRUE(
            editor().setMaterialValues(edited().materials[kind].handle, edited().source(kind).record));
    }
    ASSERT_TRUE(editor().replaceTexture(edited().textures[0].handle, edited().textures[0].view()));
    EXPECT_FALSE(store.emittersDirty || !store.lightMoves.isEmpty());
    edited().expectSameAsFresh("other edits");
}

// A material without emission becomes a light by another key.
TEST(LiveEditLampKeys, AKeyMakesAMaterialALight) {
    EditedSceneOptions options = EditedSceneOptions::withLamps(2);
    options.settings.plan.fallback = true;
    LampEdits lamps(options);
    const std::uint32_t before = lamps.emitters();
    const double dark = sumOf(lamps.edited.picture());
    // A coated material shines, which no light of the package has.
    lamps.edited.scene.materials[2]["emissiveFactor"] = {4.0F, 4.0F, 4.0F};
    const MaterialHandle coated = lamps.edited.materials[2].handle;
    const SceneEditor::Report set =
        must(lamps.edited.editor().setMaterial(coated, lamps.edited.source(2).view()));
    ASSERT_TRUE(lamps.edited.editor().setInstanceMaterial(lamps.edited.instances[1].handle, 0, coated));
    const LinearImage edited = lamps.edited.picture();
    EXPECT_EQ(lamps.emitters(), before);  // the tent was a light before
    EXPECT_GT(sumOf(edited), dark);
    // A package whose scene has such a lamp shows the same, up to the rounding of other shaders.
    gltf::Scene known = lamps.edited.scene;
    known.meshes[kKinds + 3].primitives[0].material = 2;
    const LoadedScene loaded(known, options.settings, [&](session::SceneViewData& data) {
        for (std::size_t i = 0; i < data.instances.size(); ++i) {
            data.instances[i].visible = i == 0 || i == kKinds + 3;
        }
        data.instances[0].objectToWorld = lamps.edited.instances[0].objectToWorld;
        data.instances[kKinds + 3].objectToWorld = lamps.edited.instances[1].objectToWorld;
    });
    expectSameImage(edited,
                    loaded.render(options.renderer, defaultSetup(known, options.width, options.height)),
                    "compiled with the lamp");
}

// Without a fallback, shaders sample only lights like those of the package.
TEST(LiveEditLampKeys, OtherLightsNeedAFallback) {
    LampEdits lamps(EditedSceneOptions::withLamps(2));
    EditedScene& edited = lamps.edited;
    edited.scene.materials[2]["emissiveFactor"] = {4.0F, 4.0F, 4.0F};
    const MaterialHandle coated = must(edited.editor().addMaterial(edited.source(2).view()));
    const Diagnostic set =
        mustFail(edited.editor().setInstanceMaterial(edited.instances[0].handle, 0, coated));
    EXPECT_EQ(set.id, "scene-edit-case");
    EXPECT_NE(set.message.find("clearcoat"), std::string::npos) << set.message;
    EXPECT_TRUE(edited.editor().removeMaterial(coated));
}

// A lamp that takes the place of one that was removed comes after those that were there before. Without a
// hierarchy, the order of the lights decides which random numbers they get.
TEST(LiveEditLampKeys, LampsComeInTheOrderInWhichTheyWereAdded) {
    LampEdits lamps(EditedSceneOptions::withLamps(0));
    EditedScene& edited = lamps.edited;
    for (int i = 0; i < 3; ++i) {
        EditedScene::Instance& lamp = lamps.addLamp();
        lamp.objectToWorld[3] += 0.5F * static_cast<float>(i);
        ASSERT_TRUE(edited.editor().moveInstance(lamp.handle, lamp.objectToWorld));
    }
    edited.expectSameAsFresh("three lamps");
    const InstanceHandle gone = edited.instances[2].handle;
    ASSERT_TRUE(edited.editor().removeInstance(gone));
    edited.instances.erase(edited.instances.begin() + 2);
    const EditedScene::Instance& last = lamps.addLamp();
    EXPECT_EQ(last.handle.index, gone.index);
    edited.expectSameAsFresh("one was exchanged");
}

// All content is added.
TEST(LiveEditLampKeys, AnEmptySceneGetsALamp) {
    const gltf::Scene scene = [] {
        gltf::Scene lit = catalogueScene();
        makeLamps(lit);
        return lit;
    }();
    const LoadedScene loaded(scene, EditedSceneOptions::withLamps(2).settings);
    SceneView view;
    view.editable = true;
    view.packageScene = kNoPackageScene;
    const auto empty = uploadScene(loaded.package(), view);
    ASSERT_NE(empty, nullptr);
    EXPECT_EQ(empty->state().store->counts.emitters, 0U);
    EXPECT_NE(empty->state().store->emitterRecords.device.address, 0U);
}

}  // namespace
}  // namespace glint::testing

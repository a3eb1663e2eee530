// Tests scenes that move: each pose must give the picture of the same scene uploaded in that pose.
#include "data/traversal_order.h"
#include "gltf/motion/animatable.h"
#include "gltf/motion/transform.h"
#include "render/harness.h"
#include "render/moving_scenes.h"
#include "render/scene_builder.h"
#include "scene/scene_store.h"
#include "support/halved_tree.h"
#include "support/must.h"

#include <glint/session/camera.h>
#include <glint/session/scene_view.h>

#include <array>
#include <cmath>
#include <numbers>

namespace glint::testing {
namespace {

constexpr std::uint32_t kWidth = 64;
constexpr std::uint32_t kHeight = 36;

// An uploaded scene that moves.
struct Moving : PosedScene {
    explicit Moving(const gltf::Scene& posed, bool isMoved = true)
        : PosedScene(posed, std::make_shared<const LoadedScene>(posed, compiler::PlanOptions{}),
                     [isMoved](session::SceneViewData& given) { given.moves = isMoved; }) {}

    LinearImage render() const {
        RendererOptions options;
        options.width = kWidth;
        options.height = kHeight;
        const auto renderer = makeRenderer(options);
        FrameOptions frame;
        frame.camera =
            must(session::sceneCamera(scene, 0, static_cast<double>(kWidth) / static_cast<double>(kHeight)));
        return drawn(*renderer, frame, 2);
    }
};

LinearImage renderStill(const gltf::Scene& scene) {
    return Moving(scene, false).render();
}

// Host and device round vertices differently, which moves edges and changes the colour of a few pixels.
void expectAlike(const LinearImage& image, const LinearImage& reference, const std::string& what) {
    ASSERT_EQ(image.pixels.size(), reference.pixels.size()) << what;
    std::size_t off = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        float worst = 0.0F;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            worst = std::max(worst, std::abs(image.pixels[i][channel] - reference.pixels[i][channel]));
        }
        off += worst > 2e-3F ? 1 : 0;
    }
    EXPECT_LE(off, image.pixels.size() / 200) << what << ": more pixels differ than edges have";
}

// Expects a visible difference: in 1 of 40 pixels.
void expectUnlike(const LinearImage& image, const LinearImage& other, const std::string& what) {
    std::size_t off = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        off += std::abs(image.pixels[i][0] - other.pixels[i][0]) > 0.02F ? 1 : 0;
    }
    EXPECT_GE(off, image.pixels.size() / 40) << what;
}

TEST(Motion, NodesCamerasAndLightsMove) {
    Moving moving(rigidScene());
    const LinearImage first = moving.render();
    expectSameImage(first, renderStill(moving.scene), "as uploaded");
    moving.scene.nodes[1].world = placed(0, 0.5, -2.5, 0.6);
    gltf::Matrix4 mirrored = placed(1.2, -0.2, -4);
    mirrored[0] = -2.0;
    moving.scene.nodes[2].world = mirrored;
    moving.scene.lights[0].direction = {0.6F, 0.0F, -0.8F};
    moving.scene.cameras[0].world[12] = 0.25;
    const GpuScene::MotionStatistics statistics = moving.update();
    EXPECT_EQ(statistics.refits + statistics.rebuilds + statistics.deformed, 0U) << "meshes keep their shape";
    const LinearImage second = moving.render();
    expectSameImage(second, renderStill(moving.scene), "moved");
    expectUnlike(second, first, "moved");
}

TEST(Motion, TheTopLevelFollowsItsRule) {
    Moving moving(rigidScene());
    EXPECT_EQ(moving.update().topLevel, GpuScene::MotionStatistics::TopLevel::Kept) << "nothing has moved";
    moving.scene.nodes[1].world = placed(-1, 0.5, -3);
    EXPECT_EQ(moving.update().topLevel, GpuScene::MotionStatistics::TopLevel::Updated);
    // The quad measures 1.41 m from corner to corner.
    moving.scene.nodes[1].world = placed(-1, 1.5, -3);
    EXPECT_EQ(moving.update().topLevel, GpuScene::MotionStatistics::TopLevel::Rebuilt);
    moving.scene.nodes[1].world = placed(-1, 1.6, -3);
    EXPECT_EQ(moving.update(MotionView::Builds::Rebuild).topLevel,
              GpuScene::MotionStatistics::TopLevel::Rebuilt);
    moving.scene.nodes[1].world = placed(-1, -0.5, -9);
    EXPECT_EQ(moving.update(MotionView::Builds::Refit).topLevel,
              GpuScene::MotionStatistics::TopLevel::Updated);
    expectSameImage(moving.render(), renderStill(moving.scene), "updated, though it went far");
}

// On a CPU's driver the order of instances determines the tree. A build orders them by their current places,
// and an update keeps the order.
TEST(Motion, ATopLevelThatIsBuiltAnewIsOrderedAnew) {
    constexpr std::uint32_t kCount = 64;
    gltf::Scene scene = emptyScene();
    const int material = addMaterial(scene, unlitMaterial({1, 1, 1}));
    const int mesh = addMesh(scene, makeQuad(material, {-0.4F, -0.4F, 0}, {0.8F, 0, 0}, {0, 0.8F, 0}));
    for (std::uint32_t i = 0; i < kCount; ++i) {
        // 27 and 64 share no factor, so neighbours in the file are far from each other.
        const std::uint32_t place = 27 * i % kCount;
        addInstance(scene, mesh, placed(place % 8, place / 8, -20));
    }
    addCamera(scene);
    Moving moving(scene);
    const auto order = [&] {
        std::vector<std::uint32_t> instances;
        const SceneStore& store = *moving.gpuScene->state().store;
        const RecordStore& placed = store.topLevel.records();
        for (std::uint32_t i = 0; i < placed.count(); ++i) {
            const auto instance = placed.read<VkAccelerationStructureInstanceKHR>(i);
            const std::uint32_t geometry = instance.instanceCustomIndex;
            instances.push_back(store.geometries.read<gpu::GeometryRecord>(geometry).instanceIndex);
        }
        return instances;
    };
    // Returns the cost of the tree as a multiple of the least cost.
    const auto cost = [&] {
        std::vector<LeafBox> leaves;
        for (const gltf::Node& node : moving.scene.nodes) {
            LeafBox& leaf = leaves.emplace_back();
            for (const double corner : {-0.4, 0.4}) {
                leaf.extend(std::array<float, 3>{static_cast<float>(node.world[12] + corner),
                                                 static_cast<float>(node.world[13] + corner), -20.0F});
            }
        }
        return test::halvedTreeCost(leaves, order()) / test::halvedTreeCost(leaves, halvingOrder(leaves, 1));
    };
    EXPECT_LT(cost(), 1.02);
    const std::vector<std::uint32_t> first = order();
    for (std::uint32_t i = 0; i < kCount; ++i) {
        moving.scene.nodes[i].world = placed(i % 8, i / 8, -20);
    }
    moving.update(MotionView::Builds::Refit);
    EXPECT_EQ(order(), first);
    EXPECT_GT(cost(), 1.2) << "the move is no reason for another order";
    moving.update(MotionView::Builds::Rebuild);
    EXPECT_EQ(order(), first) << "nothing has moved since";
    moving.scene.nodes[0].world = placed(0, 0, -20.5);
    moving.update(MotionView::Builds::Rebuild);
    EXPECT_LT(cost(), 1.02);
}

TEST(Motion, FlattenedInstancesHideAndComeBack) {
    Moving moving(rigidScene());
    const LinearImage whole = moving.render();
    moving.scene.nodes[1].world = scaling(0.0, 0.0, 0.0);
    moving.update();
    const LinearImage hidden = moving.render();
    expectUnlike(hidden, whole, "hidden");
    expectSameImage(hidden, renderStill(moving.scene), "hidden");
    moving.scene.nodes[1].world = placed(-1, 0, -3);
    moving.update();
    expectSameImage(moving.render(), whole, "back again");
    // An instance that is flat at upload appears later.
    gltf::Scene flat = moving.scene;
    flat.nodes[2].world = scaling(0.0, 0.0, 0.0);
    Moving later(flat);
    later.scene.nodes[2].world = moving.scene.nodes[2].world;
    later.update();
    expectSameImage(later.render(), whole, "appeared");
}

TEST(Motion, SkinsBendMeshes) {
    Moving moving(skinnedScene(0.0));
    const LinearImage straight = moving.render();
    expectAlike(straight, renderStill(bakedScene(moving.scene)), "at the pose of the upload");
    moving.scene = skinnedScene(1.2);
    const GpuScene::MotionStatistics statistics = moving.update();
    EXPECT_EQ(statistics.deformed, 1U);
    EXPECT_EQ(statistics.refits, 1U);
    EXPECT_EQ(statistics.rebuilds, 0U);
    EXPECT_EQ(statistics.topLevel, GpuScene::MotionStatistics::TopLevel::Updated);
    const LinearImage bent = moving.render();
    expectAlike(bent, renderStill(bakedScene(moving.scene)), "bent");
    expectAlike(bent, renderStill(moving.scene), "uploaded as bent");
    expectUnlike(bent, straight, "bent");
    EXPECT_EQ(moving.update().deformed, 0U) << "the same pose again";
}

TEST(Motion, RefitsSeeWhatRebuildsSee) {
    Moving refitted(skinnedScene(0.0));
    Moving rebuilt(skinnedScene(0.0));
    for (const double angle : {0.5, -1.0, 2.5}) {
        refitted.scene = skinnedScene(angle);
        rebuilt.scene = skinnedScene(angle);
        EXPECT_EQ(refitted.update(MotionView::Builds::Refit).refits, 1U);
        EXPECT_EQ(rebuilt.update(MotionView::Builds::Rebuild).rebuilds, 1U);
        expectSameImage(refitted.render(), rebuilt.render(), "at " + std::to_string(angle));
    }
}

// A mesh that follows only one joint equals that mesh in the joint's place, including normals and tangents if
// the joint stretches and mirrors.
TEST(Motion, OneJointIsATransform) {
    for (const double stretch : {1.5, -1.5}) {
        gltf::Scene scene = skinnedScene(0.0);
        gltf::Primitive& strip = scene.meshes[1].primitives[0];
        strip.influences = {1, std::vector<std::uint16_t>(strip.positions.size(), 0),
                            std::vector<float>(strip.positions.size(), 1.0F)};
        for (std::size_t i = 0; i < strip.normals.size(); ++i) {
            const float lean = 0.6F * (strip.positions[i][1] - 1.0F);
            const float length = std::sqrt(1.0F + lean * lean);
            strip.normals[i] = {0.0F, lean / length, 1.0F / length};
        }
        scene.materials.back()["roughnessFactor"] = 0.2F;
        scene.materials.back().give("KHR_materials_anisotropy");
        scene.materials.back()["anisotropyStrength"] = 0.8F;
        scene.materials.back()["anisotropyRotation"] = 0.0F;
        gltf::Matrix4 place = placed(0.2, -0.9, -2.5, 0.4);
        for (std::size_t row = 0; row < 3; ++row) {
            place[row] *= stretch;
        }
        scene.skins[0] = {"", {2}, {placed(0, 0, 0)}};
        scene.nodes[2].world = place;
        // The mesh's own transform decides which side is the front.
        scene.nodes[1].world = place;
        gltf::Scene rigid = scene;
        rigid.nodes[1].skin = -1;
        rigid.meshes[1].primitives[0].influences = {};
        expectAlike(renderStill(scene), renderStill(rigid), "stretched by " + std::to_string(stretch));
    }
}

TEST(Motion, TargetsMorphMeshes) {
    Moving moving(morphedScene({0.0, 0.0}));
    const LinearImage rest = moving.render();
    expectAlike(rest, renderStill(bakedScene(moving.scene)), "at rest");
    moving.scene = morphedScene({0.5, 1.0});
    EXPECT_EQ(moving.update().deformed, 1U);
    const LinearImage morphed = moving.render();
    expectAlike(morphed, renderStill(bakedScene(moving.scene)), "morphed");
    expectUnlike(morphed, rest, "morphed");
}

// Differences of normals turn them as if the mesh had been made with other normals.
TEST(Motion, TargetsTurnNormals) {
    gltf::Scene scene = morphedScene({1.0, 0.0});
    gltf::Primitive& strip = scene.meshes[1].primitives[0];
    gltf::Scene baked = scene;
    strip.targets[0] = {};
    strip.targets[0].normals.assign(strip.positions.size(), {1.0F, 0.0F, 0.0F});
    gltf::Primitive& turned = baked.meshes[1].primitives[0];
    turned.targets.clear();
    const float half = static_cast<float>(std::numbers::sqrt2 / 2.0);
    turned.normals.assign(turned.positions.size(), {half, 0.0F, half});
    baked.nodes[1].weights.clear();
    expectAlike(renderStill(scene), renderStill(baked), "turned");
    gltf::Scene straight = scene;
    straight.nodes[1].weights = {0.0, 0.0};
    expectUnlike(renderStill(scene), renderStill(straight), "turned");
}

TEST(Motion, WornStructuresAreBuiltAnew) {
    Moving moving(morphedScene({0.0, 0.0}));
    moving.scene.nodes[1].weights = {0.1, 0.0};
    EXPECT_EQ(moving.update().refits, 1U);
    moving.scene.nodes[1].weights = {8.0, 0.0};
    const GpuScene::MotionStatistics grown = moving.update();
    EXPECT_EQ(grown.refits, 0U);
    EXPECT_EQ(grown.rebuilds, 1U);
    for (std::uint32_t i = 0; i < kMaxRefits; ++i) {
        moving.scene.nodes[1].weights = {8.0 - 0.01 * i, 0.01};
        ASSERT_EQ(moving.update().refits, 1U) << i;
    }
    moving.scene.nodes[1].weights = {7.0, 0.0};
    EXPECT_EQ(moving.update().rebuilds, 1U) << "after as many refits as there may be";
}

// The material of node 1 gets a coat and another colour within a second.
gltf::Scene paintedScene() {
    gltf::Scene scene = rigidScene();
    const int painted = scene.meshes[1].primitives[0].material;
    materials::Material& material = scene.materials[static_cast<std::size_t>(painted)];
    material.give("KHR_materials_clearcoat");
    material["clearcoatFactor"] = 0.0F;
    material["clearcoatRoughnessFactor"] = 0.1F;
    material["clearcoatNormalScale"] = 1.0F;
    gltf::AnimatedMaterial& animated = scene.animatedMaterials.emplace_back();
    animated.material = painted;
    animated.rest = material;
    gltf::Animation& animation = scene.animations.emplace_back();
    const auto drive = [&](const char* name, std::size_t width, std::vector<float> values) {
        animation.channels.push_back({0, gltf::AnimationPath::Material,
                                      static_cast<int>(animation.samplers.size()),
                                      *gltf::findMaterialProperty(materials::builtinMaterialModel(), name)});
        animation.samplers.push_back({gltf::Interpolation::Linear, {0.0F, 1.0F}, width, std::move(values)});
    };
    drive("extensions/KHR_materials_clearcoat/clearcoatFactor", 1, {0, 1});
    drive("pbrMetallicRoughness/baseColorFactor", 4, {0, 0, 0, 1, 0.9F, 0.1F, 0.4F, 1});
    gltf::settleAnimatedValues(scene);
    return scene;
}

// Returns the scene with the values of a time in place of the file's. Its key then has only the features that
// these values need.
gltf::Scene plainScene(gltf::Scene scene, double time) {
    constexpr std::array<std::size_t, 1> kFirst{0};
    const int painted = scene.animatedMaterials[0].material;
    scene.materials[static_cast<std::size_t>(painted)] = session::poseAt(scene, kFirst, time).materials[0];
    scene.animatedMaterials.clear();
    scene.animations.clear();
    return scene;
}

TEST(Motion, MaterialsChange) {
    const gltf::Scene scene = paintedScene();
    Moving moving(scene);
    const std::size_t painted = static_cast<std::size_t>(scene.animatedMaterials[0].material);
    std::vector<LinearImage> images;
    for (const double time : {0.0, 1.0}) {
        const gltf::Scene plain = plainScene(scene, time);
        moving.scene.materials[painted] = plain.materials[painted];
        EXPECT_EQ(moving.update().topLevel, GpuScene::MotionStatistics::TopLevel::Kept);
        images.push_back(moving.render());
        expectSameImage(images.back(), renderStill(plain), "at " + std::to_string(time));
    }
    expectUnlike(images[1], images[0], "painted");
    // A scene that does not move, but was uploaded with the values of a time, shows the same picture.
    gltf::Scene posed = scene;
    posed.materials[painted] = plainScene(scene, 1.0).materials[painted];
    expectSameImage(renderStill(posed), images[1], "uploaded as painted");
    MotionView motion = moving.data.motion();
    motion.materials = {};
    const Status refused = moving.gpuScene->updateAndWait(motion);
    EXPECT_EQ(refused ? "done" : refused.error().id, "scene-material");
}

TEST(Motion, NodesThatAreNotVisibleAreNeitherDrawnNorHit) {
    gltf::Scene scene = rigidScene();
    Moving moving(scene);
    const LinearImage whole = moving.render();
    moving.scene.nodes[1].shown = false;
    moving.scene.lights[0].shown = false;
    moving.update();
    const LinearImage hidden = moving.render();
    expectUnlike(hidden, whole, "hidden");
    gltf::Scene without = scene;
    without.nodes[1].mesh = -1;
    without.lights[0].intensity = 0.0F;
    expectSameImage(hidden, renderStill(without), "hidden");
    moving.scene.nodes[1].shown = true;
    moving.scene.lights[0].shown = true;
    moving.update();
    expectSameImage(moving.render(), whole, "shown again");
    // A node that is never shown is not uploaded.
    scene.nodes[1].shown = false;
    scene.nodes[1].canShow = false;
    EXPECT_EQ(session::makeSceneView(scene).instances.size(), moving.data.instances.size() - 1);
}

// Placements of one node are drawn like nodes at the same places, with fewer calls. One of them is mirrored.
TEST(Motion, InstancesAreDrawnAsNodesAre) {
    gltf::Scene nodes = rigidScene();
    gltf::Primitive second = nodes.meshes[1].primitives[0];
    second.pointer = "/meshes/1/primitives/1";
    second.material = nodes.meshes[0].primitives[0].material;
    for (gltf::Float3& position : second.positions) {
        position[2] += 0.3F;
        position[0] += 0.4F;
    }
    nodes.meshes[1].primitives.push_back(second);
    gltf::Scene instanced = nodes;
    gltf::Instancing& instancing = instanced.instancings.emplace_back();
    instancing.count = 4;
    instancing.translations = {{0, 0, 0}, {0.6F, 0.9F, -0.5F}, {1.2F, 1.5F, -1}, {1.8F, 0.2F, -1.5F}};
    instancing.scales = {{1, 1, 1}, {0.5F, 0.5F, 0.5F}, {0.5F, 1, 1}, {-1, 1, 1}};
    instanced.nodes[1].instancing = 0;
    const gltf::Node node = nodes.nodes[1];
    for (std::size_t i = 0; i < instancing.count; ++i) {
        gltf::Node copy = node;
        copy.world = gltf::multiply(node.world, gltf::instanceTransform(instancing, i));
        if (i == 0) {
            nodes.nodes[1] = copy;
        } else {
            nodes.nodes.push_back(copy);
        }
    }
    const Moving still(instanced, false);
    expectSameImage(still.render(), renderStill(nodes), "instanced");
    // One batch is the floor. Each of the two primitives has three more: the plain placements, the mirrored
    // one, and the other node. Places share structures, so there are at most as many structures as
    // primitives.
    EXPECT_EQ(still.gpuScene->state().batches.size(), 7U);
    EXPECT_EQ(still.gpuScene->statistics().instances, 6U);
    EXPECT_LE(still.gpuScene->statistics().blasCount, still.data.primitives.size());
}

bool hasDeformModule(const Package& package) {
    for (const package::ModuleEntry& module : package.modules()) {
        if (module.role == package::ModuleRole::Deform) {
            return true;
        }
    }
    return false;
}

TEST(Motion, NothingOfItIsThereInScenesThatStay) {
    const Moving still(rigidScene(), false);
    EXPECT_FALSE(hasDeformModule(still.package()));
    EXPECT_FALSE(still.gpuScene->state().store->deformPass);
    EXPECT_EQ(still.gpuScene->state().store->topLevel.records().device.address, 0U);
    // Nodes that move need no deforming pass.
    const Moving rigid(rigidScene());
    EXPECT_FALSE(hasDeformModule(rigid.package()));
    EXPECT_FALSE(rigid.gpuScene->state().store->deformPass);
    EXPECT_TRUE(rigid.gpuScene->state().store->shaped.empty());
    EXPECT_EQ(rigid.gpuScene->statistics().blasBytes, still.gpuScene->statistics().blasBytes);
    // A picture of a single pose is deformed once, and built as if it had no other pose.
    const Moving posed(skinnedScene(0.3), false);
    EXPECT_TRUE(hasDeformModule(posed.package()));
    EXPECT_EQ(posed.gpuScene->state().store->poses.device.address, 0U);
    EXPECT_EQ(posed.gpuScene->statistics().blasCount, 2U);
}

std::string errorId(const Status& status) {
    return status ? "done" : status.error().id;
}

TEST(Motion, RefusesWhatIsNotItsScene) {
    Moving still(rigidScene(), false);
    EXPECT_EQ(errorId(still.gpuScene->updateAndWait(still.data.motion())), "scene-still");
    EXPECT_FALSE(still.gpuScene->motion().ok());
    Moving moving(skinnedScene(0.0));
    const MotionView good = moving.data.motion();
    MotionView motion = good;
    motion.lights = {};
    EXPECT_EQ(errorId(moving.gpuScene->updateAndWait(motion)), "scene-motion");
    motion = good;
    motion.instances = good.instances.subspan(1);
    EXPECT_EQ(errorId(moving.gpuScene->updateAndWait(motion)), "scene-motion");
    std::vector<InstanceView> instances(good.instances.begin(), good.instances.end());
    motion.instances = instances;
    instances[1].joints = instances[1].joints.subspan(1);
    EXPECT_EQ(errorId(moving.gpuScene->updateAndWait(motion)), "scene-motion");
    instances[1] = good.instances[0];
    EXPECT_EQ(errorId(moving.gpuScene->updateAndWait(motion)), "scene-motion") << "another mesh";
    instances[1] = good.instances[1];
    std::vector<std::array<float, 12>> joints(2);
    joints[1][3] = NAN;
    instances[1].joints = joints;
    EXPECT_EQ(errorId(moving.gpuScene->updateAndWait(motion)), "scene-motion");
    joints[1][3] = 0.0F;
    EXPECT_EQ(errorId(moving.gpuScene->updateAndWait(motion)), "done");
    // A package of the scene without its skin lacks the pass.
    gltf::Scene rigid = skinnedScene(0.0);
    rigid.nodes[1].skin = -1;
    const LoadedScene other(rigid, compiler::PlanOptions{});
    const Result<std::unique_ptr<GpuScene>> uploaded =
        GpuScene::upload(sharedContext(), other.package(), moving.data.view());
    EXPECT_EQ(uploaded ? "uploaded" : uploaded.error().id, "scene-package");
}

}  // namespace
}  // namespace glint::testing

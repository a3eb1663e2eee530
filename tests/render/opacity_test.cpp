// Alpha tests that were decided at upload: pictures do not show it, whether meshes are deformed or not, rays
// test less, and what may change is not decided.
#include "context/commands.h"
#include "render/harness.h"
#include "render/scene_builder.h"
#include "scene/scene_store.h"

#include <glint/session/material_source.h>
#include <glint/session/scene_view.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace glint::testing {
namespace {

constexpr std::uint32_t kStrategies = package::kStrategyUber | package::kStrategyVisibility |
                                      package::kStrategySortedUber | package::kStrategyHitShaders;

// Returns quads in rows, each with a part of a texture that is opaque, transparent, or has an edge.
gltf::Primitive leaves(int material, float z) {
    gltf::Primitive all = makeQuad(material, {-1, -1, z}, {0.2F, 0, 0}, {0, 0.2F, 0});
    all.positions.clear();
    all.normals.clear();
    all.texCoords0.clear();
    all.indices.clear();
    constexpr std::uint32_t kWidth = 10;
    for (std::uint32_t i = 0; i < kWidth * kWidth; ++i) {
        const float x = -1.0F + 0.2F * static_cast<float>(i % kWidth);
        const float y = -1.0F + 0.2F * static_cast<float>(i / kWidth);
        const gltf::Primitive leaf = makeQuad(material, {x, y, z + 0.02F * std::sin(5.0F * x + 3.0F * y)},
                                              {0.19F, 0, 0.01F}, {0.01F, 0.19F, 0});
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        // A third of the texture each: opaque, an edge, transparent; some mirrored and some across the seam,
        // which the others stay clear of: a lookup at 0 may read the other side.
        const float left = i % 7 == 6 ? 0.9F : 0.02F + 0.33F * static_cast<float>(i % 3);
        for (std::size_t corner = 0; corner < leaf.positions.size(); ++corner) {
            const float u = i % 4 == 1 ? 1.0F - leaf.texCoords0[corner][0] : leaf.texCoords0[corner][0];
            all.positions.push_back(leaf.positions[corner]);
            all.normals.push_back(leaf.normals[corner]);
            all.texCoords0.push_back({left + 0.3F * u, leaf.texCoords0[corner][1]});
        }
        for (const std::uint32_t index : leaf.indices) {
            all.indices.push_back(first + index);
        }
    }
    return all;
}

// A masked material whose texture is opaque on the left, transparent on the right, and has an edge between.
materials::Material leafMaterial(gltf::Scene& scene, float cutoff) {
    std::vector<std::uint8_t> texels;
    for (int y = 0; y < 12; ++y) {
        for (int x = 0; x < 36; ++x) {
            const int edge = 18 + (y * 7) % 5 - 2;
            texels.insert(texels.end(),
                          {static_cast<std::uint8_t>(60 + 5 * x), 160, 60,
                           static_cast<std::uint8_t>(std::clamp(128 + 60 * (edge - x), 0, 255))});
        }
    }
    materials::Material leaf;
    leaf.alphaMode = materials::AlphaMode::Mask;
    leaf["alphaCutoff"] = cutoff;
    leaf.doubleSided = true;
    leaf.texture("baseColorTexture").texture = addTexture(scene, 36, 12, texels);
    return leaf;
}

// A mirror below, a wall behind, a sun and a camera.
void addSurroundings(gltf::Scene& scene) {
    const int mirror = addMaterial(scene, mirrorMaterial());
    const int wall = addMaterial(scene, unlitMaterial({0.2F, 0.3F, 0.7F}));
    addQuad(scene, mirror, {-4, -1.2F, 0}, {8, 0, 0}, {0, 0, -8});
    addQuad(scene, wall, {-6, -3, -6}, {12, 0, 0}, {0, 8, 0});
    addDirectionalLight(scene, {0.3F, -1.0F, -0.4F}, 3.0F);
    addCamera(scene);
}

// Masked and blended leaves over a mirror, lit by the sun, before a wall.
gltf::Scene foliage(float cutoff = 0.5F) {
    gltf::Scene scene = emptyScene();
    const materials::Material leaf = leafMaterial(scene, cutoff);
    materials::Material veil = leaf;
    veil.alphaMode = materials::AlphaMode::Blend;
    const int mask = addMaterial(scene, leaf);
    const int blend = addMaterial(scene, veil);
    const int mesh = addMesh(scene, leaves(mask, -2.5F));
    for (int i = 0; i < 3; ++i) {
        gltf::Matrix4 world = scaling(1, 1, 1);
        world[12] = 0.3 * i - 0.3;
        world[14] = -0.4 * i;
        addInstance(scene, mesh, world);
    }
    addInstance(scene, addMesh(scene, leaves(blend, -2.2F)));
    addSurroundings(scene);
    return scene;
}

compiler::CompileSettings settingsOf(std::uint32_t strategies) {
    compiler::CompileSettings settings;
    settings.strategies = strategies;
    settings.tracers = package::kAllTracers;
    settings.plan.keys.alpha = package::AlphaPolicy::Stochastic;
    return settings;
}

std::function<void(session::SceneViewData&)> use(SceneView::OpacityUse opacity) {
    return [opacity](session::SceneViewData& data) { data.opacity = opacity; };
}

TEST(Opacity, PicturesDoNotShowWhatWasDecided) {
    const gltf::Scene scene = foliage();
    const compiler::CompileSettings settings = settingsOf(kStrategies);
    const LoadedScene proved(scene, settings, use(SceneView::OpacityUse::Proved));
    const LoadedScene tested(scene, settings, use(SceneView::OpacityUse::Tested));
    const GpuScene::Statistics& statistics = proved.gpuScene().statistics();
    EXPECT_EQ(statistics.maskedTriangles, 200U);
    EXPECT_GT(statistics.provedOpaque, 40U);
    EXPECT_GT(statistics.provedTransparent, 40U);
    EXPECT_LT(statistics.provedOpaque + statistics.provedTransparent, 200U);
    EXPECT_EQ(tested.gpuScene().statistics().provedOpaque, 0U);
    EXPECT_EQ(statistics.triangles, tested.gpuScene().statistics().triangles) << "all are drawn";

    RenderSetup setup = defaultSetup(scene, 64, 36);
    setup.countsLight = true;
    std::vector<RendererOptions> choices;
    for (const package::Strategy strategy : {package::kStrategyUber, package::kStrategyVisibility,
                                             package::kStrategySortedUber, package::kStrategyHitShaders}) {
        for (const package::Tracer tracer : {package::kTracerRayQuery, package::kTracerRayPipeline}) {
            const bool ownPipeline = strategy == package::kStrategyHitShaders;
            if ((sharedContext().handles().tracers & tracer) != 0 &&
                (!ownPipeline || tracer == package::kTracerRayPipeline)) {
                choices.push_back({.strategy = strategy, .tracer = tracer});
            }
        }
    }
    for (const RendererOptions& options : choices) {
        Renderer::Counters few;
        Renderer::Counters many;
        const LinearImage image = proved.render(options, setup, &few);
        EXPECT_EQ(image.pixels, tested.render(options, setup, &many).pixels)
            << "strategy " << options.strategy << ", tracer " << *options.tracer;
        EXPECT_GT(few.alphaTests, 0U);
        EXPECT_LT(few.alphaTests, many.alphaTests);
    }
}

constexpr int kFrames = 3;
constexpr std::size_t kJoint = 2;  // the node that bends the leaves of node 0

// Masked leaves that two joints carry, and ones with a morph target, in a frame of their animation.
gltf::Scene swayingFoliage(int frame) {
    gltf::Scene scene = emptyScene();
    const int mask = addMaterial(scene, leafMaterial(scene, 0.5F));
    gltf::Primitive bent = leaves(mask, 0.0F);
    bent.influences.count = 2;
    for (const gltf::Float3& position : bent.positions) {
        const float up = std::clamp(0.5F + 0.5F * position[1], 0.0F, 1.0F);
        bent.influences.joints.insert(bent.influences.joints.end(), {0, 1});
        bent.influences.weights.insert(bent.influences.weights.end(), {1.0F - up, up});
    }
    gltf::Primitive morphed = leaves(mask, 0.0F);
    morphed.targets.resize(1);
    for (const gltf::Float3& position : morphed.positions) {
        morphed.targets[0].positions.push_back({0.3F * position[1], 0, 0.4F * position[0] * position[1]});
    }
    addInstance(scene, addMesh(scene, std::move(bent)));
    gltf::Matrix4 world = scaling(1, 1, 1);
    world[12] = 0.3;
    world[14] = -3.1;
    addInstance(scene, addMesh(scene, std::move(morphed)), world);
    scene.meshes[1].weights = {0.0};
    scene.nodes[1].weights = {0.45 * frame};
    const double angle = 0.35 * frame;
    gltf::Node joint;
    joint.world = {std::cos(angle),
                   std::sin(angle),
                   0,
                   0,
                   -std::sin(angle),
                   std::cos(angle),
                   0,
                   0,
                   0,
                   0,
                   1,
                   0,
                   0.1 * frame,
                   0,
                   -2.5,
                   1};
    scene.nodes.push_back(joint);
    joint.world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -2.5, 1};
    scene.nodes.push_back(joint);
    gltf::Skin skin;
    skin.joints = {static_cast<int>(kJoint) + 1, static_cast<int>(kJoint)};
    skin.inverseBinds.assign(2, scaling(1, 1, 1));
    scene.skins.push_back(skin);
    scene.nodes[0].skin = 0;
    addSurroundings(scene);
    return scene;
}

// An uploaded scene that moves, whose alpha tests are decided or not.
struct Swaying : PosedScene {
    Swaying(std::shared_ptr<const LoadedScene> loaded, SceneView::OpacityUse use)
        : PosedScene(swayingFoliage(0), std::move(loaded),
                     [use](session::SceneViewData& given) { given.opacity = use; }) {}
    void moveTo(int frame) {
        scene.nodes = swayingFoliage(frame).nodes;
        update();
    }
};

// States depend on UVs, so that triangles which were decided at rest stay decided wherever skins and morph
// targets take them.
TEST(Opacity, PicturesOfDeformedMeshesDoNotShowWhatWasDecided) {
    const gltf::Scene still = swayingFoliage(0);
    const auto compiled = std::make_shared<const LoadedScene>(
        still, settingsOf(package::kStrategyUber | package::kStrategyHitShaders));
    std::vector<RendererOptions> choices{
        {.strategy = package::kStrategyUber, .tracer = package::kTracerRayQuery}};
    if ((sharedContext().handles().tracers & package::kTracerRayPipeline) != 0) {
        choices.push_back({.strategy = package::kStrategyHitShaders, .tracer = package::kTracerRayPipeline});
    }
    RenderSetup setup = defaultSetup(still, 64, 36);
    Swaying proved(compiled, SceneView::OpacityUse::Proved);
    Swaying tested(compiled, SceneView::OpacityUse::Tested);
    EXPECT_EQ(proved.gpuScene->statistics().maskedTriangles, 400U);
    EXPECT_GT(proved.gpuScene->statistics().provedOpaque, 80U);
    EXPECT_GT(proved.gpuScene->statistics().provedTransparent, 80U);
    EXPECT_EQ(tested.gpuScene->statistics().provedOpaque, 0U);
    for (RendererOptions& options : choices) {
        options.countsLight = true;
        options.width = setup.width;
        options.height = setup.height;
        const auto few = proved.makeRenderer(options);
        const auto many = tested.makeRenderer(options);
        ASSERT_TRUE(few != nullptr && many != nullptr);
        LinearImage before;
        for (int frame = 0; frame < kFrames; ++frame) {
            proved.moveTo(frame);
            tested.moveTo(frame);
            const Result<LinearImage> image = few->render(setup.frame, 1);
            const Result<LinearImage> reference = many->render(setup.frame, 1);
            ASSERT_TRUE(image && reference);
            const std::string what =
                "strategy " + std::to_string(options.strategy) + ", frame " + std::to_string(frame);
            EXPECT_EQ(image->pixels, reference->pixels) << what;
            EXPECT_NE(image->pixels, before.pixels) << what << ": nothing has moved";
            EXPECT_LT(few->counters()->alphaTests, many->counters()->alphaTests) << what;
            EXPECT_GT(few->counters()->alphaTests, 0U) << what;
            before = *image;
        }
    }
}

// Rays to lights that keep a share of it test alpha too.
TEST(Opacity, TestsOfRaysThroughGlassAreCounted) {
    gltf::Scene scene = foliage();
    materials::Material pane;
    pane["metallicFactor"] = 0.0F;
    pane["transmissionFactor"] = 1.0F;
    addQuad(scene, pane, {-4, 3, 0}, {8, 0, 0}, {0, 0, -8});
    RenderSetup setup = defaultSetup(scene, 64, 36);
    setup.countsLight = true;
    const auto testsWith = [&](package::ShadowThrough through) {
        compiler::CompileSettings settings = settingsOf(package::kStrategyUber);
        settings.tracers = package::kTracerRayQuery;
        settings.shadowThrough = through;
        settings.effects = {false, compiler::builtinEffects({"shadow"})};
        const LoadedScene loaded(scene, settings, use(SceneView::OpacityUse::Tested));
        Renderer::Counters counters;
        loaded.render(package::kStrategyUber, setup, &counters);
        return counters.alphaTests;
    };
    const std::uint32_t alone = testsWith(package::ShadowThrough::Alpha);
    EXPECT_GT(alone, 0U);
    // A ray whose light ends at a leaf may have met other leaves before that, in an order of the driver's.
    EXPECT_GT(testsWith(package::ShadowThrough::Glass), alone / 2);
}

TEST(Opacity, NothingIsDecidedAboutWhatMayChange) {
    const gltf::Scene scene = foliage();
    const compiler::CompileSettings settings = settingsOf(package::kStrategyUber);
    const auto provedOf = [&](const std::function<void(session::SceneViewData&)>& change) {
        const LoadedScene loaded(scene, settings, change);
        return loaded.gpuScene().statistics().provedOpaque;
    };
    EXPECT_GT(provedOf({}), 0U);
    // The material of an animated scene, whose cutoff or factor an update may change.
    EXPECT_EQ(provedOf([](session::SceneViewData& data) {
                  data.moves = true;
                  data.materials.push_back({0, {}});
                  data.materialRecords.emplace_back();
              }),
              0U);
    // An unmoved material of a scene that moves stays decided.
    EXPECT_GT(provedOf([](session::SceneViewData& data) { data.moves = true; }), 0U);
}

void recordEdits(GpuScene& scene, std::uint64_t frame) {
    const Status status = runOnce(sharedContext().state(), [&](VkCommandBuffer commands) {
        return scene.editor()->record(commands, frame);
    });
    EXPECT_TRUE(status) << (status ? "" : toString(status.error()));
    scene.complete(frame);
}

std::size_t decidedInstances(const LoadedScene& loaded) {
    std::size_t count = 0;
    loaded.gpuScene().state().store->instanceSlots.forEach(
        [&](InstanceHandle, const StoredInstance& instance) {
            count += instance.form != nullptr && instance.form->decides ? 1 : 0;
        });
    return count;
}

// A scene that is edited and begins sealed has the same decisions, until an edit changes what they rely on.
TEST(Opacity, SealedInstancesAreDecidedUntilTheirAlphaChanges) {
    const gltf::Scene scene = foliage();
    const compiler::CompileSettings settings = settingsOf(package::kStrategyUber);
    const LoadedScene open(scene, settings, [](session::SceneViewData& data) { data.editable = true; });
    const LoadedScene sealed(scene, settings,
                             [](session::SceneViewData& data) { data.editable = data.sealed = true; });
    RenderSetup setup = defaultSetup(scene, 64, 36);
    setup.countsLight = true;
    const auto compare = [&](const std::string& what) {
        std::array<Renderer::Counters, 2> counters;
        const LinearImage expected = open.render(package::kStrategyUber, setup, &counters[0]);
        EXPECT_EQ(sealed.render(package::kStrategyUber, setup, &counters[1]).pixels, expected.pixels) << what;
        return std::array{counters[1].alphaTests, counters[0].alphaTests};
    };
    EXPECT_EQ(decidedInstances(sealed), 3U);
    const auto [few, many] = compare("as uploaded");
    EXPECT_LT(few, many);
    std::uint64_t frame = 1;
    const auto editBoth = [&](const auto& edit) {
        ++frame;
        for (const LoadedScene* const one : {&open, &sealed}) {
            edit(*one->gpuScene().editor());
            recordEdits(one->gpuScene(), frame);
        }
    };
    editBoth([&](SceneEditor& editor) {
        EXPECT_TRUE(editor.setInstanceMaterial(editor.instance(1), 0, editor.material(3)));
        EXPECT_TRUE(editor.showInstance(editor.instance(0), false));
    });
    compare("one has another material, another is hidden");
    EXPECT_EQ(decidedInstances(sealed), 2U) << "the others stay sealed";
    materials::Material leaf = scene.materials[0];
    const compiler::MaterialLayout layout = session::recordLayoutOf(sealed.package(), leaf.model());
    leaf["baseColorFactor"] = {0.5F, 0.9F, 0.5F, 1.0F};
    editBoth([&](SceneEditor& editor) {
        EXPECT_TRUE(editor.showInstance(editor.instance(0), true));
        EXPECT_TRUE(editor.setMaterialValues(editor.material(0), compiler::makeMaterialRecord(leaf, layout)));
    });
    compare("another colour");
    EXPECT_EQ(decidedInstances(sealed), 2U) << "which alpha tests do not read";
    leaf["alphaCutoff"] = 0.9F;
    editBoth([&](SceneEditor& editor) {
        EXPECT_TRUE(editor.setMaterialValues(editor.material(0), compiler::makeMaterialRecord(leaf, layout)));
    });
    compare("another cutoff");
    EXPECT_EQ(decidedInstances(sealed), 0U);
    EXPECT_EQ(sealed.gpuScene().statistics().geometries, open.gpuScene().statistics().geometries);
    editBoth([&](SceneEditor& editor) { EXPECT_TRUE(editor.seal(std::array{editor.instance(0)})); });
    compare("sealed without decisions");
    EXPECT_EQ(decidedInstances(sealed), 0U);
}

// A cutoff of 0 makes all leaves opaque, one above 1 none.
TEST(Opacity, TheCutoffDecides) {
    const compiler::CompileSettings settings = settingsOf(package::kStrategyUber);
    const LoadedScene none(foliage(1.5F), settings);
    EXPECT_EQ(none.gpuScene().statistics().provedTransparent, 200U);
    const RenderSetup setup = defaultSetup(foliage(), 64, 36);
    const LoadedScene tested(foliage(1.5F), settings, use(SceneView::OpacityUse::Tested));
    EXPECT_EQ(none.render(package::kStrategyUber, setup).pixels,
              tested.render(package::kStrategyUber, setup).pixels);
}

}  // namespace
}  // namespace glint::testing

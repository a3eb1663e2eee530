// Alpha tests that were decided at upload: pictures do not show it, rays test less, and what may change is
// not decided.
#include "render/harness.h"
#include "render/scene_builder.h"

#include <algorithm>
#include <cmath>

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

// Masked and blended leaves over a mirror, lit by the sun, before a wall.
gltf::Scene foliage(float cutoff = 0.5F) {
    gltf::Scene scene = emptyScene();
    std::vector<std::uint8_t> texels;
    for (int y = 0; y < 12; ++y) {
        for (int x = 0; x < 36; ++x) {
            const int edge = 18 + (y * 7) % 5 - 2;
            texels.insert(texels.end(),
                          {static_cast<std::uint8_t>(60 + 5 * x), 160, 60,
                           static_cast<std::uint8_t>(std::clamp(128 + 60 * (edge - x), 0, 255))});
        }
    }
    materials::Material leaf = unlitMaterial({1, 1, 1});
    leaf = materials::Material();
    leaf.alphaMode = materials::AlphaMode::Mask;
    leaf["alphaCutoff"] = cutoff;
    leaf.doubleSided = true;
    leaf.texture("baseColorTexture").texture = addTexture(scene, 36, 12, texels);
    materials::Material veil = leaf;
    veil.alphaMode = materials::AlphaMode::Blend;
    const int mask = addMaterial(scene, leaf);
    const int blend = addMaterial(scene, veil);
    const int mirror = addMaterial(scene, mirrorMaterial());
    const int wall = addMaterial(scene, unlitMaterial({0.2F, 0.3F, 0.7F}));
    const int mesh = addMesh(scene, leaves(mask, -2.5F));
    for (int i = 0; i < 3; ++i) {
        gltf::Matrix4 world = scaling(1, 1, 1);
        world[12] = 0.3 * i - 0.3;
        world[14] = -0.4 * i;
        addInstance(scene, mesh, world);
    }
    addInstance(scene, addMesh(scene, leaves(blend, -2.2F)));
    addInstance(scene, addMesh(scene, makeQuad(mirror, {-4, -1.2F, 0}, {8, 0, 0}, {0, 0, -8})));
    addInstance(scene, addMesh(scene, makeQuad(wall, {-6, -3, -6}, {12, 0, 0}, {0, 8, 0})));
    addDirectionalLight(scene, {0.3F, -1.0F, -0.4F}, 3.0F);
    addCamera(scene);
    return scene;
}

compiler::CompileSettings settingsOf(std::uint32_t strategies) {
    compiler::CompileSettings settings;
    settings.strategies = strategies;
    settings.tracers = package::kAllTracers;
    settings.plan.keys.alpha = package::AlphaPolicy::Stochastic;
    return settings;
}

std::function<void(scene_view::SceneViewData&)> use(OpacityUse opacity) {
    return [opacity](scene_view::SceneViewData& data) { data.opacity = opacity; };
}

TEST(Opacity, PicturesDoNotShowWhatWasDecided) {
    const gltf::Scene scene = foliage();
    const compiler::CompileSettings settings = settingsOf(kStrategies);
    const LoadedScene proved(scene, settings, use(OpacityUse::Proved));
    const LoadedScene tested(scene, settings, use(OpacityUse::Tested));
    ASSERT_TRUE(proved.ok() && tested.ok());
    const GpuScene::Statistics& statistics = proved.gpuScene().statistics();
    EXPECT_EQ(statistics.maskedTriangles, 200U);
    EXPECT_GT(statistics.provedOpaque, 40U);
    EXPECT_GT(statistics.provedTransparent, 40U);
    EXPECT_LT(statistics.provedOpaque + statistics.provedTransparent, 200U);
    EXPECT_EQ(tested.gpuScene().statistics().provedOpaque, 0U);
    EXPECT_EQ(statistics.triangles, tested.gpuScene().statistics().triangles) << "all are drawn";

    RenderSetup setup = defaultSetup(scene, 64, 36);
    setup.frame.countsLight = true;
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
        FrameCounters few;
        FrameCounters many;
        const LinearImage image = proved.render(options, setup, &few);
        ASSERT_FALSE(image.pixels.empty());
        EXPECT_EQ(image.pixels, tested.render(options, setup, &many).pixels)
            << "strategy " << options.strategy << ", tracer " << *options.tracer;
        EXPECT_GT(few.alphaTests, 0U);
        EXPECT_LT(few.alphaTests, many.alphaTests);
    }
    expectNoValidationMessages();
}

TEST(Opacity, NothingIsDecidedAboutWhatMayChange) {
    const gltf::Scene scene = foliage();
    const compiler::CompileSettings settings = settingsOf(package::kStrategyUber);
    const auto provedOf = [&](const std::function<void(scene_view::SceneViewData&)>& change) {
        const LoadedScene loaded(scene, settings, change);
        return loaded.ok() ? loaded.gpuScene().statistics().provedOpaque : ~0ULL;
    };
    EXPECT_GT(provedOf({}), 0U);
    // The material of an animated scene, whose cutoff or factor an update may change.
    EXPECT_EQ(provedOf([](scene_view::SceneViewData& data) {
                  data.moves = true;
                  data.materials.push_back({0, {}});
                  data.materialRecords.emplace_back();
              }),
              0U);
    // An unmoved material of a scene that moves stays decided.
    EXPECT_GT(provedOf([](scene_view::SceneViewData& data) { data.moves = true; }), 0U);
    expectNoValidationMessages();
}

// A cutoff of 0 makes all leaves opaque, one above 1 none.
TEST(Opacity, TheCutoffDecides) {
    const compiler::CompileSettings settings = settingsOf(package::kStrategyUber);
    const LoadedScene none(foliage(1.5F), settings);
    ASSERT_TRUE(none.ok());
    EXPECT_EQ(none.gpuScene().statistics().provedTransparent, 200U);
    const RenderSetup setup = defaultSetup(foliage(), 64, 36);
    const LoadedScene tested(foliage(1.5F), settings, use(OpacityUse::Tested));
    ASSERT_TRUE(tested.ok());
    EXPECT_EQ(none.render(package::kStrategyUber, setup).pixels,
              tested.render(package::kStrategyUber, setup).pixels);
    expectNoValidationMessages();
}

}  // namespace
}  // namespace glint::testing

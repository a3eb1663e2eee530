// What views read: layers whose values can be known, equal in every strategy.
#include "render/hall.h"
#include "render/layered_scene.h"
#include "render/scene_builder.h"
#include "render/ways.h"

#include <glint/measure/views.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

constexpr std::uint32_t kNothing = 0xFFFFFFFF;

// A wall that fills the left half of the picture, 3 m ahead, with a checkered texture of 64 by 64 texels. A
// light shines along the view.
gltf::Scene litWall() {
    gltf::Scene scene = emptyScene();
    addCamera(scene);
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < 64 * 64; ++i) {
        const auto value = static_cast<std::uint8_t>((i + i / 64) % 2 == 0 ? 255 : 64);
        texels.insert(texels.end(), {value, value, value, value});
    }
    const int texture = addTexture(scene, 64, 64, texels);
    materials::Material paper;
    paper.texture("baseColorTexture").texture = texture;
    addInstance(scene,
                addMesh(scene, makeQuad(addMaterial(scene, paper), {-6, -3, -3}, {6, 0, 0}, {0, 6, 0})));
    addDirectionalLight(scene, {0, 0, -1}, 3.0F);
    return scene;
}

compiler::CompileSettings settingsWith(std::vector<std::string> layers) {
    compiler::CompileSettings settings;
    settings.layers = std::move(layers);
    settings.effects = {false, compiler::builtinEffects({"shadow"})};
    return settings;
}

TEST(Views, LayersHaveTheValuesOfASceneThatIsKnown) {
    gltf::Scene scene = litWall();
    // A fence behind the camera, which every ray to the light passes through once.
    materials::Material fence;
    fence.alphaMode = materials::AlphaMode::Mask;
    fence.texture("baseColorTexture").texture = 0;
    addInstance(scene,
                addMesh(scene, makeQuad(addMaterial(scene, fence), {-9, -9, 2}, {18, 0, 0}, {0, 18, 0})));
    compiler::CompileSettings settings = settingsWith(
        {"rays", "candidates", "non-finite", "texture-level", "footprint", "branches", "lobes", "shader"});
    settings.plan.keys.alpha = package::AlphaPolicy::Tested;
    LayeredScene shown(scene, settings, 16, 16);
    ASSERT_TRUE(shown.ok());
    shown.render();
    const LayerSet layers(shown.renderer());
    std::size_t oneCandidate = 0;
    for (std::size_t i = 0; i < 16 * 16; ++i) {
        EXPECT_EQ(layers.integer("non-finite", i), 0U);
        if (i % 16 >= 8) {
            EXPECT_EQ(layers.integer("rays", i), 0U);
            EXPECT_EQ(layers.integer("candidates", i), 0U);
            EXPECT_EQ(layers.integer("lobes", i), kNothing);
            EXPECT_EQ(layers.integer("branches", i), kNothing);
            EXPECT_EQ(layers.at("footprint", i, 0), 0.0F);
            continue;
        }
        EXPECT_EQ(layers.integer("rays", i), 1U) << "to the light";
        // On the diagonal of the fence a ray may meet both triangles.
        EXPECT_GE(layers.integer("candidates", i), 1U);
        EXPECT_LE(layers.integer("candidates", i), 2U);
        oneCandidate += layers.integer("candidates", i) == 1 ? 1 : 0;
    }
    EXPECT_GT(oneCandidate, 100U);
    // In the middle a pixel is 0.375 m wide, which are 4 texels: level 2.
    const std::size_t middle = 8 * 16 + 7;
    EXPECT_NEAR(layers.at("footprint", middle, 0), 0.375, 0.005);
    EXPECT_NEAR(layers.at("texture-level", middle, 0), 2.0, 0.05);
    expectNoValidationMessages();
}

TEST(Views, SumsAreOverAllSamples) {
    const gltf::Scene scene = litWall();
    const LoadedScene loaded(scene, settingsWith({"rays"}));
    ASSERT_TRUE(loaded.ok());
    RendererOptions options;
    options.width = 16;
    options.height = 16;
    const auto renderer = Renderer::create(sharedContext(), loaded.package(), loaded.gpuScene(), options);
    ASSERT_TRUE(renderer.ok());
    for (int picture = 0; picture < 2; ++picture) {
        ASSERT_TRUE((*renderer)->render(defaultSetup(scene, 16, 16).frame, 3).ok());
        EXPECT_EQ(LayerSet(**renderer).integer("rays", 8 * 16 + 4), 3U) << "and each picture begins anew";
    }
}

TEST(Views, CountInfiniteSamples) {
    gltf::Scene scene = litWall();
    addDirectionalLight(scene, {0, 0, -1}, 3e38F);
    addDirectionalLight(scene, {0, 0, -1}, 3e38F);
    addDirectionalLight(scene, {0, 0, -1}, 3e38F);
    addDirectionalLight(scene, {0, 0, -1}, 3e38F);
    LayeredScene shown(scene, settingsWith({"non-finite"}), 16, 16);
    ASSERT_TRUE(shown.ok());
    shown.render();
    const LayerSet layers(shown.renderer());
    EXPECT_EQ(layers.integer("non-finite", 8 * 16 + 4), package::kInfiniteSample);
    EXPECT_EQ(layers.integer("non-finite", 8 * 16 + 12), 0U);
}

TEST(Views, EveryStrategyGivesTheSame) {
    const gltf::Scene scene = hallScene();
    compiler::CompileSettings settings;
    const std::vector<std::string> same{"shader", "lobes", "material", "reflection.hit-shader", "rays"};
    settings.layers = same;
    settings.layers.insert(settings.layers.end(), {"cases-run", "workgroup"});
    settings.plan.merge = compiler::MergePolicy::None;
    std::map<std::string, std::vector<std::uint32_t>> first;
    forEachWay(scene, settings, [&](const LoadedScene& loaded, const Way& way) {
        RendererOptions options = optionsOf(way);
        options.width = 48;
        options.height = 28;
        const auto renderer = Renderer::create(sharedContext(), loaded.package(), loaded.gpuScene(), options);
        ASSERT_TRUE(renderer.ok()) << toString(renderer.error());
        ASSERT_TRUE((*renderer)->render(defaultSetup(scene, 48, 28).frame, 1).ok());
        const LayerSet layers(**renderer);
        std::size_t hits = 0;
        std::uint32_t mostCases = 0;
        for (std::size_t i = 0; i < 48 * 28; ++i) {
            const bool isHit = layers.integer("reflection.hit-shader", i) < package::kRayEndedOnScreen;
            const std::uint32_t cases = layers.integer("reflection.cases-run", i);
            hits += isHit ? 1 : 0;
            if (cases != kNothing) {
                EXPECT_TRUE(isHit);
                EXPECT_GE(cases, 1U);
                mostCases = std::max(mostCases, cases);
            }
            EXPECT_EQ(cases == kNothing, layers.integer("reflection.workgroup", i) == kNothing);
        }
        EXPECT_GT(hits, 100U);
        if (package::infoOf(way.strategy).ordersHits) {
            EXPECT_LE(mostCases, 1U) << nameOf(way) << ": ordered hits of a subgroup have one case";
        }
        for (const std::string& layer : same) {
            std::vector<std::uint32_t> values;
            for (std::size_t i = 0; i < 48 * 28; ++i) {
                values.push_back(layers.integer(layer, i));
            }
            EXPECT_EQ(first.try_emplace(layer, values).first->second, values) << nameOf(way) << ": " << layer;
        }
        expectNoValidationMessages();
    });
}

TEST(Views, AreMadeOfARenderersLayers) {
    const gltf::Scene scene = hallScene();
    const measure::ViewChoice choice = *measure::parseView("reflection.hit-shader");
    compiler::CompileSettings settings;
    settings.layers = measure::layersFor(choice);
    LayeredScene shown(scene, settings, 32, 18);
    ASSERT_TRUE(shown.ok());
    shown.render();
    measure::ViewInput input;
    input.package = &shown.package();
    const Result<measure::View> view = measure::makeView(choice, shown.renderer(), input);
    ASSERT_TRUE(view.ok()) << toString(view.error());
    std::uint64_t pixels = 0;
    for (const measure::ViewStatistics::Category& one : view->statistics.categories) {
        pixels += one.pixels;
    }
    EXPECT_EQ(pixels, 32U * 18U);
    EXPECT_EQ(view->picture.pixels.size(), 32U * 18U);

    const auto missing = measure::makeView(*measure::parseView("rays"), shown.renderer(), input);
    ASSERT_FALSE(missing.ok());
    EXPECT_EQ(missing.error().id, "view-layer");
    const auto unknown =
        measure::makeView(*measure::parseView("refraction.hit-shader"), shown.renderer(), input);
    ASSERT_FALSE(unknown.ok());
    EXPECT_EQ(unknown.error().id, "view-source");
    const auto alone = measure::makeView(*measure::parseView("difference"), shown.renderer(), input);
    ASSERT_FALSE(alone.ok());
    EXPECT_EQ(alone.error().id, "view-reference");
}

}  // namespace
}  // namespace glint::testing

// What views read: layers whose values can be known, equal in every strategy.
#include "context/context.h"
#include "render/edited_scene.h"
#include "render/hall.h"
#include "render/layered_scene.h"
#include "render/scene_builder.h"
#include "render/ways.h"
#include "scene/scene_store.h"
#include "support/must.h"

#include <glint/measure/views.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

constexpr std::uint32_t kNothing = 0xFFFFFFFF;

// A wall that fills the left half of the picture, 3 m ahead, with a checkered texture of 64 by 64 texels. A
// light shines along the view.
gltf::Scene litWall() {
    gltf::Scene scene = sceneWithCamera();
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < 64 * 64; ++i) {
        const auto value = static_cast<std::uint8_t>((i + i / 64) % 2 == 0 ? 255 : 64);
        texels.insert(texels.end(), {value, value, value, value});
    }
    const int texture = addTexture(scene, 64, 64, texels);
    materials::Material paper;
    paper.texture("baseColorTexture").texture = texture;
    // Changes nothing, so that no pixel reads it. Its texels are much larger.
    paper.texture("normalTexture").texture = addTexture(scene, 2, 2, std::vector<std::uint8_t>(16, 200));
    paper["normalScale"] = 0.0F;
    addQuad(scene, paper, {-6, -3, -3}, {6, 0, 0}, {0, 6, 0});
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
    addQuad(scene, fence, {-9, -9, 2}, {18, 0, 0}, {0, 18, 0});
    compiler::CompileSettings settings = settingsWith(
        {"rays", "candidates", "non-finite", "texture-level", "footprint", "branches", "lobes", "shader"});
    settings.plan.keys.alpha = package::AlphaPolicy::Tested;
    LayeredScene shown(scene, settings, 16, 16);
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
}

TEST(Views, SumsAreOverAllSamples) {
    const gltf::Scene scene = litWall();
    const LoadedScene loaded(scene, settingsWith({"rays"}));
    RendererOptions options;
    options.width = 16;
    options.height = 16;
    const auto renderer = loaded.makeRenderer(options);
    for (int picture = 0; picture < 2; ++picture) {
        must(renderer->render(defaultSetup(scene, 16, 16).frame, 3));
        EXPECT_EQ(LayerSet(*renderer).integer("rays", 8 * 16 + 4), 3U) << "and each picture begins anew";
    }
}

TEST(Views, CountInfiniteSamples) {
    gltf::Scene scene = litWall();
    addDirectionalLight(scene, {0, 0, -1}, 3e38F);
    addDirectionalLight(scene, {0, 0, -1}, 3e38F);
    addDirectionalLight(scene, {0, 0, -1}, 3e38F);
    addDirectionalLight(scene, {0, 0, -1}, 3e38F);
    LayeredScene shown(scene, settingsWith({"non-finite"}), 16, 16);
    shown.render();
    const LayerSet layers(shown.renderer());
    EXPECT_EQ(layers.integer("non-finite", 8 * 16 + 4), package::kInfiniteSample);
    EXPECT_EQ(layers.integer("non-finite", 8 * 16 + 12), 0U);
}

// A wall on the left and one on the right, 3 m ahead. They share their mesh's shape alone.
gltf::Scene twoWalls(const materials::Material& left, const materials::Material& right, float z) {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, left, {-9, -9, z}, {9, 0, 0}, {0, 18, 0});
    addQuad(scene, right, {0, -9, z}, {9, 0, 0}, {0, 18, 0});
    addDirectionalLight(scene, {0, 0, -1}, 3.0F);
    return scene;
}

std::uint64_t pixelsOf(const measure::View& view, std::string_view category) {
    for (const measure::ViewStatistics::Category& one : view.statistics.categories) {
        if (one.category.name == category) {
            return one.pixels;
        }
    }
    return 0;
}

TEST(Views, FindWhatIsNotANumber) {
    materials::Material plain;
    plain["metallicFactor"] = 0.0F;
    materials::Material broken = plain;
    broken["emissiveFactor"] = {1.0F, std::numeric_limits<float>::quiet_NaN(), 0.0F};
    const gltf::Scene scene = twoWalls(plain, broken, -3);
    LayeredScene shown(scene, settingsWith({"non-finite"}), 16, 16);
    shown.render();
    measure::ViewInput input;
    input.package = &shown.package();
    const measure::View view =
        must(measure::makeView(*measure::parseView("non-finite"), shown.renderer(), input));
    EXPECT_EQ(pixelsOf(view, "not a number"), 128U);
    EXPECT_EQ(pixelsOf(view, "finite"), 128U);
    for (std::size_t i = 0; i < 16 * 16; ++i) {
        EXPECT_EQ(view.picture.pixels[i] == view.picture.pixels[15], i % 16 >= 8) << i;
    }
}

// A mirror that fills the picture shows two walls. No case has the lobes of one and the inputs of the other
// together.
gltf::Scene mirroredWalls() {
    materials::Material textured;
    textured.texture("baseColorTexture").texture = 0;
    materials::Material coated;
    coated.give("KHR_materials_clearcoat");
    coated["clearcoatFactor"] = 1.0F;
    gltf::Scene scene = twoWalls(textured, coated, 3);
    addTexture(scene, 2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 9, 9, 9, 255});
    for (gltf::Mesh& mesh : scene.meshes) {
        mesh.primitives[0].indices = {0, 2, 1, 0, 3, 2};  // they face the mirror
    }
    addQuad(scene, mirrorMaterial(), {-9, -9, -3}, {18, 0, 0}, {0, 18, 0});
    return scene;
}

// Draws the scene, and expects the view to find the right half of the hits in that category and the rest to
// have cases.
void expectRightHalf(const gltf::Scene& scene, const LoadedScene& loaded, GpuScene& gpuScene,
                     std::string_view category) {
    RendererOptions options;
    options.width = 16;
    options.height = 16;
    const auto renderer = makeRenderer(loaded.package(), gpuScene, options);
    must(renderer->render(defaultSetup(scene, 16, 16).frame, 1));
    measure::ViewInput input;
    input.package = &loaded.package();
    const measure::View view = must(measure::makeView(*measure::parseView("fallback"), *renderer, input));
    EXPECT_EQ(pixelsOf(view, category), 128U);
    EXPECT_EQ(pixelsOf(view, "has a case"), 128U);
    for (std::size_t i = 0; i < 16 * 16; ++i) {
        EXPECT_EQ(view.picture.pixels[i] == view.picture.pixels[15], i % 16 >= 8) << i;
    }
}

compiler::CompileSettings settingsOfHits(bool hasFallback) {
    compiler::CompileSettings settings;
    settings.layers = {"hit-shader"};
    settings.plan.fallback = hasFallback;
    settings.plan.merge = compiler::MergePolicy::None;
    return settings;
}

TEST(Views, FindHitsOfTheFallback) {
    const gltf::Scene scene = mirroredWalls();
    const LoadedScene loaded(scene, settingsOfHits(true));
    const auto gpuScene = uploadScene(loaded.package(), scene, [](SceneView& view) { view.editable = true; });
    ASSERT_NE(gpuScene, nullptr);
    SceneEditor& editor = *gpuScene->editor();
    materials::Material both = scene.materials[1];
    both.texture("baseColorTexture").texture = 0;
    const session::MaterialSourceData source = session::makeMaterialSource(
        loaded.package(), session::recordLayoutOf(loaded.package(), both.model()), scene, both,
        session::uploadedTextures(editor, loaded.package().scene(0), scene));
    const MaterialHandle added = must(editor.addMaterial(source.view()));
    const SceneEditor::Report set = must(editor.setInstanceMaterial(editor.instance(1), 0, added));
    EXPECT_EQ(set.missing.size(), 1U);
    TwoFrames frames(sharedContext());
    must(editor.record(frames.begin(), frames.frame()));
    frames.submit();
    frames.drain();
    expectRightHalf(scene, loaded, *gpuScene, "fallback");
}

// A defect is planted, because an editor without a fallback takes no material without a case.
TEST(Views, FindHitsWithoutACase) {
    constexpr std::uint32_t kUnknown = 77;
    const gltf::Scene scene = mirroredWalls();
    const LoadedScene loaded(scene, settingsOfHits(false));
    const GpuScene::State& state = loaded.gpuScene().state();
    const std::uint32_t wall = loaded.package().scene(0).primitives[1].shaderId;
    const auto place = std::ranges::find(state.shaderIds, wall) - state.shaderIds.begin();
    TwoFrames frames(sharedContext());
    const VkCommandBuffer commands = frames.begin();
    const Context::State& context = sharedContext().state();
    const VkDeviceSize record = static_cast<VkDeviceSize>(place) * sizeof(gpu::GeometryRecord);
    context.vk.CmdFillBuffer(commands, state.store->geometries.device.handle.get(),
                             record + offsetof(gpu::GeometryRecord, shaderId), sizeof kUnknown, kUnknown);
    frames.submit();
    frames.drain();
    expectRightHalf(scene, loaded, loaded.gpuScene(), "no case: magenta");
}

TEST(Views, CostNeedsNoRays) {
    const measure::ViewChoice cost = *measure::parseView("cost");
    materials::Material plain;
    plain["metallicFactor"] = 0.0F;
    materials::Material coated = plain;
    coated.give("KHR_materials_clearcoat");
    coated["clearcoatFactor"] = 1.0F;
    LayeredScene shown(twoWalls(plain, coated, -3), settingsWith(measure::layersFor(cost)), 16, 16);
    shown.render();
    measure::ViewInput input;
    input.package = &shown.package();
    const measure::View view = must(measure::makeView(cost, shown.renderer(), input));
    EXPECT_EQ(view.statistics.numbers, 256U);
    EXPECT_LT(view.statistics.least, view.statistics.greatest) << "the coat costs more";
    EXPECT_NEAR(view.statistics.mean, (view.statistics.least + view.statistics.greatest) / 2.0, 1e-6);
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
        const auto renderer = loaded.makeRenderer(options);
        must(renderer->render(defaultSetup(scene, 48, 28).frame, 1));
        const LayerSet layers(*renderer);
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
    });
}

TEST(Views, AreMadeOfARenderersLayers) {
    const gltf::Scene scene = hallScene();
    const measure::ViewChoice choice = *measure::parseView("reflection.hit-shader");
    compiler::CompileSettings settings;
    settings.layers = measure::layersFor(choice);
    LayeredScene shown(scene, settings, 32, 18);
    shown.render();
    measure::ViewInput input;
    input.package = &shown.package();
    const measure::View view = must(measure::makeView(choice, shown.renderer(), input));
    std::uint64_t pixels = 0;
    for (const measure::ViewStatistics::Category& one : view.statistics.categories) {
        pixels += one.pixels;
    }
    EXPECT_EQ(pixels, 32U * 18U);
    EXPECT_EQ(view.picture.pixels.size(), 32U * 18U);

    EXPECT_EQ(mustFail(measure::makeView(*measure::parseView("rays"), shown.renderer(), input)).id,
              "view-layer");
    EXPECT_EQ(
        mustFail(measure::makeView(*measure::parseView("refraction.hit-shader"), shown.renderer(), input)).id,
        "view-source");
    EXPECT_EQ(mustFail(measure::makeView(*measure::parseView("difference"), shown.renderer(), input)).id,
              "view-reference");
}

}  // namespace
}  // namespace glint::testing

// Layers beside the picture: their values against scenes whose geometry is known, and that they add up to the
// picture.
#include "render/hall.h"
#include "render/layered_scene.h"
#include "render/scene_builder.h"
#include "render/ways.h"
#include "support/must.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

compiler::CompileSettings everyLayer() {
    compiler::CompileSettings settings;
    settings.layers = {"all"};
    settings.effects = {false,
                        compiler::builtinEffects({"shadow", "reflection", "refraction", "indirect-diffuse"})};
    return settings;
}

// The hall, with a pane of glass before it.
gltf::Scene hallBehindGlass() {
    gltf::Scene scene = hallScene();
    materials::Material glass;
    glass.give("KHR_materials_transmission");
    glass["transmissionFactor"] = 0.9F;
    glass["metallicFactor"] = 0.0F;
    glass["roughnessFactor"] = 0.1F;
    addQuad(scene, glass, {-1.5F, -0.5F, -2}, {1, 0, 0}, {0, 1, 0});
    return scene;
}

TEST(Layers, DemodulatedLightTimesAlbedoGivesThePicture) {
    const gltf::Scene scene = hallBehindGlass();
    forEachWay(scene, everyLayer(), [](const LoadedScene& loaded, const Way& way) {
        RendererOptions options = optionsOf(way);
        options.width = 48;
        options.height = 28;
        for (const std::uint32_t samples : {1U, 3U}) {
            options.accumulate = samples > 1;
            const auto renderer = loaded.makeRenderer(options);
            FrameOptions frame = defaultSetup(hallBehindGlass(), options.width, options.height).frame;
            frame.maxReflectionRoughness = 1.0F;
            const LinearImage image = must(renderer->render(frame, samples));
            LinearImage sum = image;
            const LayerSet layers(*renderer);
            const std::pair<const char*, const char*> sources[] = {{"direct", "albedo"},
                                                                   {"reflection", "albedo-specular"},
                                                                   {"refraction", "albedo-transmission"},
                                                                   {"indirect-diffuse", "albedo-diffuse"}};
            for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
                for (std::size_t c = 0; c < 3; ++c) {
                    sum.pixels[i][c] = layers.at("emission", i, c);
                    for (const auto& [source, albedo] : sources) {
                        const float light = layers.at(std::string(source) + ".demodulated", i, c);
                        sum.pixels[i][c] += light * layers.at(albedo, i, c);
                        EXPECT_NEAR(
                            light * layers.at(albedo, i, c),
                            layers.at(std::string(source) + ".radiance", i, c),
                            1e-5F * std::max(1.0F, layers.at(std::string(source) + ".radiance", i, c)));
                    }
                }
            }
            expectSameImage(sum, image, nameOf(way) + ", " + std::to_string(samples) + " samples");
            for (const auto& [source, albedo] : sources) {
                EXPECT_GT(layers.sum(std::string(source) + ".radiance"), 0.0) << source << " brings no light";
            }
        }
    });
}

TEST(Layers, BouncesAddUpToTheLightOfTheirEffect) {
    const gltf::Scene scene = hallBehindGlass();
    compiler::CompileSettings settings = everyLayer();
    settings.plan.merge = compiler::MergePolicy::All;
    settings.maxBounces = 6;
    const std::uint32_t bounces = package::kMostLayerBounces;
    forEachWay(scene, settings, [&](const LoadedScene& loaded, const Way& way) {
        RendererOptions options = optionsOf(way);
        options.width = 24;
        options.height = 14;
        options.bounces = 6;
        const auto renderer = loaded.makeRenderer(options);
        FrameOptions frame = defaultSetup(scene, options.width, options.height).frame;
        frame.maxReflectionRoughness = 1.0F;
        must(renderer->render(frame, 2));
        const LayerSet layers(*renderer);
        for (const std::string source : {"reflection", "refraction", "indirect-diffuse"}) {
            const std::string albedo = source == "reflection"   ? "albedo-specular"
                                       : source == "refraction" ? "albedo-transmission"
                                                                : "albedo-diffuse";
            for (std::size_t i = 0; i < std::size_t{options.width} * options.height; ++i) {
                for (std::size_t c = 0; c < 3; ++c) {
                    double sum = 0.0;
                    double again = 0.0;
                    for (std::uint32_t bounce = 1; bounce <= bounces; ++bounce) {
                        sum += layers.at(fmt::format("{}.bounce-radiance.{}", source, bounce), i, c);
                        again += layers.at(fmt::format("{}.bounce-demodulated.{}", source, bounce), i, c) *
                                 layers.at(albedo, i, c);
                    }
                    const double whole = layers.at(source + ".radiance", i, c);
                    EXPECT_NEAR(sum, whole, 1e-5 * std::max(1.0, whole)) << source << ", " << nameOf(way);
                    EXPECT_NEAR(again, whole, 1e-5 * std::max(1.0, whole)) << source << ", " << nameOf(way);
                }
            }
        }
        // Later bounces are there, and have rays of their own.
        for (std::uint32_t bounce = 1; bounce <= bounces; ++bounce) {
            const std::string number = "." + std::to_string(bounce);
            EXPECT_GT(layers.sum("indirect-diffuse.bounce-radiance" + number), 0.0) << bounce;
            EXPECT_GT(layers.sum("indirect-diffuse.bounce-distance" + number), 0.0) << bounce;
        }
    });
}

// A pane before a lamp that rays find. The walk through the pane finds it before the end of its ray.
TEST(Layers, LightsThatRefractedRaysFindAreOfTheRefraction) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material glass;
    glass["transmissionFactor"] = 1.0F;
    glass["metallicFactor"] = 0.0F;
    glass["roughnessFactor"] = 0.0F;
    glass["baseColorFactor"] = {0.25F, 0.5F, 0.75F, 1.0F};
    glass.doubleSided = true;
    addQuad(scene, glass, {-9, -9, -1}, {18, 0, 0}, {0, 18, 0});
    gltf::Light lamp;
    lamp.type = gltf::LightType::Point;
    lamp.position = {0.2F, 0, -3};
    lamp.intensity = 2.0F;
    scene.lights.push_back(lamp);
    compiler::CompileSettings settings = everyLayer();
    settings.strategies = package::kStrategyUber;
    settings.sizedLights = compiler::SizedLights::On;
    settings.maxBounces = 2;
    const LoadedScene loaded(scene, settings,
                             [](session::SceneViewData& data) { data.lights[0].size = 0.8F; });
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.width = options.height = 16;
    options.bounces = 2;
    const auto renderer = loaded.makeRenderer(options);
    FrameOptions frame = defaultSetup(scene, 16, 16).frame;
    frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    for (const bool refracts : {true, false}) {
        frame.effects = refracts ? package::kAllEffects : ~compiler::builtinEffects({"refraction"});
        const LinearImage image = must(renderer->render(frame, 3));
        const LayerSet layers(*renderer);
        LinearImage sum = image;
        for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
            for (std::size_t c = 0; c < 3; ++c) {
                sum.pixels[i][c] = layers.at("emission", i, c);
                for (const std::string source : {"direct", "reflection", "refraction", "indirect-diffuse"}) {
                    sum.pixels[i][c] += layers.at(source + ".radiance", i, c);
                }
                EXPECT_NEAR(layers.at("refraction.bounce-radiance.1", i, c) +
                                layers.at("refraction.bounce-radiance.2", i, c),
                            layers.at("refraction.radiance", i, c), 1e-4);
            }
        }
        expectSameImage(sum, image, refracts ? "with refraction" : "without refraction");
        EXPECT_EQ(layers.sum("refraction.radiance") > 1.0, refracts);
        EXPECT_EQ(layers.sum("refraction.variance") > 0.0, refracts);
    }
}

TEST(Layers, LeaveThePictureAsItIs) {
    const gltf::Scene scene = hallScene();
    const RenderSetup setup = defaultSetup(scene, 48, 28);
    compiler::CompileSettings settings = everyLayer();
    const LoadedScene with(scene, settings);
    settings.layers.clear();
    const LoadedScene without(scene, settings);
    EXPECT_TRUE(without.package().layers().empty());
    expectSameImage(with.render(package::kDefaultStrategy, setup),
                    without.render(package::kDefaultStrategy, setup), "with layers");
    const auto imagesOf = [&](const LoadedScene& loaded) {
        const auto renderer = loaded.makeRenderer({});
        return renderer ? renderer->footprint().images : 0;
    };
    EXPECT_EQ(imagesOf(with), imagesOf(without) + with.package().layers().size());
}

// A layer that needs nothing but its image adds its image; no package has a buffer or a pass of layers that
// are off.
TEST(Layers, LeaveNoBufferOrPassWhereTheyAreOff) {
    const gltf::Scene scene = hallScene();
    const auto footprintWith = [&](std::vector<std::string> layers) {
        compiler::CompileSettings settings = everyLayer();
        settings.layers = std::move(layers);
        const LoadedScene loaded(scene, settings);
        RendererOptions options;
        options.width = 16;
        options.height = 16;
        const auto renderer = loaded.makeRenderer(options);
        return renderer ? renderer->footprint() : Renderer::Footprint{};
    };
    const Renderer::Footprint none = footprintWith({});
    const Renderer::Footprint depth = footprintWith({"depth"});
    const Renderer::Footprint distance = footprintWith({"reflection.distance"});
    ASSERT_GT(none.buffers, 0U);
    EXPECT_EQ(depth.images, none.images + 1);
    EXPECT_EQ(depth.buffers, none.buffers);
    EXPECT_EQ(depth.pipelines, none.pipelines);
    EXPECT_EQ(distance.images, none.images + 1);
    EXPECT_EQ(distance.buffers, none.buffers + 1) << "what each ray hit";
    EXPECT_EQ(distance.pipelines, none.pipelines);
}

TEST(Layers, ShowThePrimarySurface) {
    // A red metal wall 3 m ahead, turned by 45 degrees about Y, and an unlit one beside it.
    gltf::Scene scene = sceneWithCamera();
    materials::Material metal;
    metal["baseColorFactor"] = {0.8F, 0.2F, 0.1F, 1.0F};
    metal["roughnessFactor"] = 0.4F;
    addMaterial(scene, unlitMaterial({0.25F, 0.5F, 0.75F}));
    addMaterial(scene, metal);
    addQuad(scene, 1, {-2, -10, -5}, {2, 0, 2}, {0, 20, 0});
    addQuad(scene, 0, {0, -10, -3}, {1, 0, 0}, {0, 20, 0});
    compiler::CompileSettings settings = everyLayer();
    settings.layers = {"surface"};
    settings.plan.merge = compiler::MergePolicy::None;
    LayeredScene shown(scene, settings, 32, 32);
    shown.render();
    const LayerSet layers(shown.renderer());
    for (std::size_t i = 0; i < 32 * 32; ++i) {
        const double x = (static_cast<double>(i % 32) + 0.5) / 16.0 - 1.0;
        const std::size_t row = i / 32;
        const double y = 1.0 - (static_cast<double>(row) + 0.5) / 16.0;
        // The ray (x, y, -1) t meets the planes z = x - 3 and z = -3.
        const double t = x < 0.0 ? 3.0 / (1.0 + x) : 3.0;
        const bool isWall = x < 0.0 && t * x > -2.0;
        const bool isUnlit = x >= 0.0 && t * x < 1.0;
        if (!isWall && !isUnlit) {
            EXPECT_EQ(layers.at("depth", i, 0), 0.0F);
            EXPECT_EQ(layers.integer("material", i), 0xFFFFFFFFU);
            EXPECT_EQ(layers.at("albedo", i, 0), 0.0F);
            EXPECT_GT(layers.at("emission", i, 2), 0.0F) << "the sky";
            continue;
        }
        EXPECT_NEAR(layers.at("depth", i, 0), t, 1e-4);
        EXPECT_NEAR(layers.at("position", i, 0), t * x, 1e-4);
        EXPECT_NEAR(layers.at("position", i, 1), t * y, 1e-4);
        EXPECT_NEAR(layers.at("position", i, 2), -t, 1e-4);
        const double half = std::sqrt(0.5);
        for (const char* const normal : {"normal", "geometric-normal"}) {
            EXPECT_NEAR(layers.at(normal, i, 0), isWall ? -half : 0.0, 1e-4) << normal;
            EXPECT_NEAR(layers.at(normal, i, 2), isWall ? half : 1.0, 1e-4) << normal;
        }
        EXPECT_EQ(layers.integer("material", i), isWall ? 1U : 0U);
        EXPECT_NE(layers.integer("shader", i), 0xFFFFFFFFU);
        EXPECT_NEAR(layers.at("roughness", i, 0), isWall ? 0.4 : 1.0, 1e-5);
        EXPECT_NEAR(layers.at("emission", i, 1), isWall ? 0.0 : 0.5, 1e-5);
        EXPECT_NEAR(layers.at("albedo-diffuse", i, 0), 1.0 / 1024.0, 1e-6) << "a metal has none";
        if (isWall) {
            EXPECT_GT(layers.at("albedo-specular", i, 0), 0.7F);
            EXPECT_LT(layers.at("albedo-specular", i, 0), 1.0F);
            EXPECT_LT(layers.at("albedo-specular", i, 2), layers.at("albedo-specular", i, 0));
        }
    }
    // The two materials have different keys, and so different shaders.
    EXPECT_NE(layers.integer("shader", 16 * 32 + 12), layers.integer("shader", 16 * 32 + 18));
}

TEST(Layers, VarianceIsThatOfTheSamples) {
    const gltf::Scene scene = hallScene();
    compiler::CompileSettings settings = everyLayer();
    settings.layers = {"indirect-diffuse.variance", "direct.variance"};
    const LoadedScene loaded(scene, settings);
    EXPECT_EQ(loaded.package().layers().size(), 4U) << "radiance, from which it is computed, is there too";
    RendererOptions options;
    options.width = 24;
    options.height = 14;
    const auto renderer = loaded.makeRenderer(options);
    constexpr std::uint32_t kSamples = 5;
    const auto luminance = [](const LayerSet& layers, const std::string& name, std::size_t i) {
        return 0.2126 * layers.at(name, i, 0) + 0.7152 * layers.at(name, i, 1) +
               0.0722 * layers.at(name, i, 2);
    };
    std::vector<std::vector<double>> means;  // of the first 1, 2, … samples
    const auto keep = [&] {
        const LayerSet layers(*renderer);
        std::vector<double>& mean = means.emplace_back();
        for (std::size_t i = 0; i < 24 * 14; ++i) {
            mean.push_back(luminance(layers, "indirect-diffuse.radiance", i));
        }
        return okStatus();
    };
    const FrameOptions frame = defaultSetup(scene, options.width, options.height).frame;
    must(renderer->render(frame, kSamples, keep));
    const LayerSet layers(*renderer);
    std::size_t noisy = 0;
    for (std::size_t i = 0; i < 24 * 14; ++i) {
        // The samples follow from the means.
        double mean = 0.0;
        double squares = 0.0;
        for (std::size_t n = 0; n < kSamples; ++n) {
            const double before = n == 0 ? 0.0 : means[n - 1][i] * static_cast<double>(n);
            const double sample = means[n][i] * static_cast<double>(n + 1) - before;
            const double change = sample - mean;
            mean += change / static_cast<double>(n + 1);
            squares += change * (sample - mean);
        }
        const double variance = squares / (kSamples - 1);
        EXPECT_NEAR(layers.at("indirect-diffuse.variance", i, 0), variance, 1e-3 * std::max(variance, 1e-3));
        noisy += variance > 1e-6 ? 1 : 0;
    }
    EXPECT_GT(noisy, 24U) << "rays that go everywhere are noisy";
}

TEST(Layers, ErrorsSayWhatThereIs) {
    const gltf::Scene scene = hallScene();
    compiler::CompileSettings settings;
    settings.layers = {"refraction.radiance"};
    EXPECT_EQ(mustFail(compiler::compilePackage({&scene, 1}, settings)).id, "layer-effect");
    settings.layers = {"reflexion.radiance"};
    const Diagnostic misspelt = mustFail(compiler::compilePackage({&scene, 1}, settings));
    EXPECT_NE(toString(misspelt).find("reflection"), std::string::npos) << toString(misspelt);
    settings.layers = {"depth"};
    settings.passes = package::Passes::Steps;
    EXPECT_EQ(mustFail(compiler::compilePackage({&scene, 1}, settings)).id, "passes");
}

}  // namespace
}  // namespace glint::testing

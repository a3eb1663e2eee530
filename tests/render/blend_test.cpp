// Tests alphaMode BLEND: the mean of many random choices is what the operator "over" gives for surfaces in
// the order of depth, for what the camera sees, for what rays hit, and for what shadow rays pass.
#include "gltf/import.h"
#include "interop/scene.h"
#include "render/pixel_test.h"
#include "support/models.h"
#include "support/must.h"

#include <glint/internal/package_modules.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <optional>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

struct Layer {
    gltf::Float3 color;
    float alpha;
};

// From front to back. The last one is opaque.
constexpr std::array<Layer, 3> kLayers{Layer{kRed, 0.25F}, Layer{kGreen, 0.6F}, Layer{kBlue, 1.0F}};

int addLayer(gltf::Scene& scene, const Layer& layer) {
    materials::Material material = unlitMaterial(layer.color);
    material.doubleSided = true;
    material.alphaMode = materials::AlphaMode::Blend;
    material["baseColorFactor"][3] = layer.alpha;
    return addMaterial(scene, material);
}

// Returns the layers in front of the camera; or behind it, where a mirror in front of it shows them.
gltf::Scene stackedLayers(bool inMirror) {
    gltf::Scene scene = sceneWithCamera();
    if (inMirror) {
        const int mirror = addMaterial(scene, mirrorMaterial());
        addQuad(scene, mirror, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    }
    float distance = 1.0F;
    for (const Layer& layer : kLayers) {
        const float z = inMirror ? distance : -distance;
        addQuad(scene, addLayer(scene, layer), {-9, -9, z}, {18, 0, 0}, {0, 18, 0});
        distance += 1.0F;
    }
    return scene;
}

// The mean and the variance of one channel of a sample.
struct Moments {
    double mean = 0.0;
    double variance = 0.0;
};

Moments momentsOf(std::size_t channel) {
    double mean = 0.0;
    double square = 0.0;
    double seen = 1.0;
    for (const Layer& layer : kLayers) {
        const double color = layer.color[channel];
        mean += seen * layer.alpha * color;
        square += seen * layer.alpha * color * color;
        seen *= 1.0 - layer.alpha;
    }
    return {mean, square - mean * mean};
}

Moments measured(const LinearImage& image, std::size_t channel) {
    Moments result;
    for (const Pixel& pixel : image.pixels) {
        result.mean += pixel[channel];
        result.variance += pixel[channel] * pixel[channel];
    }
    const auto count = static_cast<double>(image.pixels.size());
    result.mean /= count;
    result.variance = result.variance / count - result.mean * result.mean;
    return result;
}

void expectOver(const LinearImage& image, double samples) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const Moments expected = momentsOf(channel);
        const double error =
            std::sqrt(expected.variance / (samples * static_cast<double>(image.pixels.size())));
        EXPECT_NEAR(measured(image, channel).mean, expected.mean, 4.0 * error) << "channel " << channel;
    }
}

compiler::CompileSettings blendSettings() {
    compiler::CompileSettings settings;
    settings.plan.keys.alpha = package::AlphaPolicy::Stochastic;
    settings.strategies = package::allStrategies();
    settings.tracers = package::kAllTracers;
    return settings;
}

TEST(Blend, TheCameraSeesLayersOverEachOther) {
    const gltf::Scene scene = stackedLayers(false);
    const LoadedScene loaded(scene, blendSettings());
    RenderSetup setup = squareSetup(scene);
    const LinearImage once = loaded.render(package::kStrategyUber, setup);
    expectOver(once, 1.0);
    for (const Pixel& pixel : once.pixels) {
        const bool whole = std::ranges::any_of(
            kLayers, [&](const Layer& layer) { return std::abs(pixel[0] - layer.color[0]) < 1e-5F; });
        ASSERT_TRUE(whole) << "a sample shows " << pixel[0];
    }
    // Samples of a pixel are spread over the interval, so that noise falls faster than by chance.
    setup.samples = 16;
    const LinearImage often = loaded.render(package::kStrategyUber, setup);
    expectOver(often, 16.0);
    EXPECT_LT(measured(often, 0).variance, 0.7 * momentsOf(0).variance / 16.0);
}

// The picture of a mirror is that of the camera, whoever traces and shades, and all of them choose alike.
TEST(Blend, RaysSeeLayersOverEachOther) {
    const gltf::Scene scene = stackedLayers(true);
    const LoadedScene loaded(scene, blendSettings());
    RenderSetup setup = squareSetup(scene);
    setup.samples = 2;
    std::optional<LinearImage> reference;
    for (const package::StrategyInfo& strategy : package::strategyTable()) {
        for (const package::Tracer tracer : {package::kTracerRayQuery, package::kTracerRayPipeline}) {
            const bool pairs = !strategy.ownPipeline || tracer == package::kTracerRayPipeline;
            if (!pairs || (sharedContext().handles().tracers & tracer) == 0) {
                continue;
            }
            RendererOptions options;
            options.strategy = strategy.strategy;
            options.tracer = tracer;
            const LinearImage image = loaded.render(options, setup);
            if (!reference) {
                expectOver(image, 2.0);
                reference = image;
            }
            expectSameImage(image, *reference, std::string(strategy.name));
        }
    }
}

TEST(Blend, ShadowsAreAsDarkAsTheAlpha) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material white;
    white["metallicFactor"] = 0.0F;
    addQuad(scene, white, {-4, -4, -2}, {8, 0, 0}, {0, 8, 0});
    addDirectionalLight(scene, {0.0F, -0.9284767F, -0.3713907F}, 3.0F);
    RenderSetup setup = squareSetup(scene);
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    const LoadedScene bare(scene, blendSettings());
    const LinearImage lit = bare.render(package::kStrategyUber, setup);
    // The plate is above the frustum, and between the sun and all of the wall that the camera sees.
    const int plate = addLayer(scene, kLayers[0]);
    addQuad(scene, plate, {-8, 3, 0.5F}, {16, 0, 0}, {0, 0, -2.4F});
    setup.samples = 4;
    const LoadedScene covered(scene, blendSettings());
    const LinearImage shaded = covered.render(package::kStrategyUber, setup);
    ASSERT_EQ(shaded.pixels.size(), lit.pixels.size());
    double share = 0.0;
    for (std::size_t i = 0; i < lit.pixels.size(); ++i) {
        share += shaded.pixels[i][1] / lit.pixels[i][1];
    }
    const auto count = static_cast<double>(lit.pixels.size());
    const double error = std::sqrt(0.25 * 0.75 / (4.0 * count));
    EXPECT_NEAR(share / count, 0.75, 4.0 * error);
}

// The stations of the scene below stand side by side, so far apart that no picture shows two.
constexpr float kStationDistance = 100.0F;
constexpr float kLitAlpha = 0.4F;
enum class LitLayer : std::uint8_t { Blended, Opaque, None };
constexpr std::array kLitLayers{LitLayer::Blended, LitLayer::Opaque, LitLayer::None};

// Returns stations of a lit background behind a lit layer with a coat that emits light: the layer is blended,
// opaque, or not there. The camera looks at the first three stations. At three others a mirror shows what is
// behind the camera.
gltf::Scene litStations() {
    gltf::Scene scene = sceneWithCamera();
    materials::Material layer;
    layer["baseColorFactor"] = {0.7F, 0.3F, 0.2F, kLitAlpha};
    layer["metallicFactor"] = 0.0F;
    layer["roughnessFactor"] = 0.5F;
    layer["specularColorFactor"] = {1.0F, 0.8F, 0.6F};
    layer["emissiveFactor"] = {0.05F, 0.2F, 0.1F};
    layer["clearcoatFactor"] = 1.0F;
    layer["clearcoatRoughnessFactor"] = 0.4F;
    layer.doubleSided = true;
    layer.alphaMode = materials::AlphaMode::Blend;
    materials::Material whole = layer;
    whole.alphaMode = materials::AlphaMode::Opaque;
    materials::Material matte;
    matte["baseColorFactor"] = {0.1F, 0.4F, 0.9F, 1.0F};
    matte["metallicFactor"] = 0.0F;
    matte["roughnessFactor"] = 1.0F;
    matte.doubleSided = true;
    const int blended = addMaterial(scene, layer);
    const int opaque = addMaterial(scene, whole);
    const int background = addMaterial(scene, matte);
    const int mirror = addMaterial(scene, mirrorMaterial());
    float x = 0.0F;
    for (const bool inMirror : {false, true}) {
        for (const LitLayer kind : kLitLayers) {
            const auto add = [&](int material, float half, float z) {
                addQuad(scene, material, {x - half, -half, z}, {2 * half, 0, 0}, {0, 2 * half, 0});
            };
            const float behind = inMirror ? 1.0F : -1.0F;
            if (inMirror) {
                add(mirror, 1.0F, -1.0F);
            }
            if (kind != LitLayer::None) {
                add(kind == LitLayer::Blended ? blended : opaque, 9.0F, behind);
            }
            add(background, 9.0F, 2.0F * behind);
            x += kStationDistance;
        }
    }
    addDirectionalLight(scene, {0.3F, -0.5F, -0.8124038F}, 3.0F);
    addDirectionalLight(scene, {-0.2F, -0.3F, 0.9327379F}, 2.0F);
    return scene;
}

// A blended layer counts with all of its light: of lobes, coat and emission.
TEST(Blend, LitLayersAreOverTheirBackground) {
    const gltf::Scene scene = litStations();
    compiler::CompileSettings settings = blendSettings();
    settings.strategies = package::kStrategyUber;
    // Shadows of the layers would fall onto the background.
    settings.effects = {false, compiler::builtinEffects({"reflection"})};
    const LoadedScene loaded(scene, settings);
    RenderSetup setup = squareSetup(scene);
    setup.samples = 16;
    for (const bool inMirror : {false, true}) {
        std::array<LinearImage, kLitLayers.size()> images;
        for (std::size_t i = 0; i < images.size(); ++i) {
            const std::size_t station = i + (inMirror ? images.size() : 0);
            setup.frame.camera.position[0] = kStationDistance * static_cast<float>(station);
            images[i] = loaded.render(package::kStrategyUber, setup);
            ASSERT_FALSE(images[i].pixels.empty());
        }
        const auto& [blended, layer, background] = images;
        const auto count = static_cast<double>(blended.pixels.size());
        for (std::size_t channel = 0; channel < 3; ++channel) {
            double found = 0.0;
            double expected = 0.0;
            double variance = 0.0;
            for (std::size_t i = 0; i < blended.pixels.size(); ++i) {
                const double front = layer.pixels[i][channel];
                const double back = background.pixels[i][channel];
                found += blended.pixels[i][channel] / count;
                expected += (kLitAlpha * front + (1.0 - kLitAlpha) * back) / count;
                variance += kLitAlpha * (1.0 - kLitAlpha) * (front - back) * (front - back) / count;
            }
            const double error = std::sqrt(variance / (setup.samples * count));
            std::printf("%s, channel %zu: %.5f, expected %.5f ± %.5f\n", inMirror ? "mirror" : "camera",
                        channel, found, expected, error);
            EXPECT_NEAR(found, expected, 4.0 * error) << "channel " << channel;
            EXPECT_GT(variance, 1e-3) << "layer and background look alike";
        }
    }
}

// Khronos's AlphaBlendModeTest: the label of an opaque surface has a green check mark, drawn with an alpha
// that must be ignored, over a red cross. The one of BLEND has a clear sheet over a check mark.
TEST(Blend, AlphaBlendModeTestShowsItsCheckMarks) {
    const auto path = test::modelsFolder() / "features" / "AlphaBlendModeTest" / "AlphaBlendModeTest.gltf";
    if (!std::filesystem::exists(path)) {
        GTEST_SKIP() << test::noModels(path);
    }
    gltf::ImportOptions import;
    import.decodeImages = true;
    gltf::Scene scene = must(gltf::importScene(path, import));
    // The marks lie on slanted labels; the camera looks along their normal.
    constexpr double kUp = 0.5547002;
    constexpr double kBack = 0.8320503;
    addCamera(scene);
    gltf::Camera& camera = scene.cameras.front();
    camera.yfov = 2.0 * std::atan(0.13);
    camera.world = {1, 0, 0, 0, 0, kUp, -kBack, 0, 0, kBack, kUp, 0, 0, kBack, 0.409 + kUp, 1};
    compiler::CompileSettings settings = blendSettings();
    settings.strategies = package::kStrategyUber;
    settings.effects = {false, 0};
    const LoadedScene loaded(scene, settings);
    RenderSetup setup = squareSetup(scene);
    for (const float x : {-2.6F, -1.1F}) {
        setup.frame.camera.position[0] = x;
        const LinearImage image = loaded.render(package::kStrategyUber, setup);
        // The mark fills the middle, and its columns differ from those beside it.
        const auto share = [&](std::uint32_t first, std::uint32_t last, std::size_t high, std::size_t low) {
            int count = 0;
            for (std::uint32_t column = first; column < last; ++column) {
                for (std::uint32_t row = 0; row < image.height; ++row) {
                    const Pixel pixel = at(image, column, row);
                    count += pixel[high] > 2.0F * pixel[low] ? 1 : 0;
                }
            }
            return static_cast<double>(count) / ((last - first) * image.height);
        };
        EXPECT_GT(share(8, 24, 1, 0), 0.1) << "no green mark at " << x;
        EXPECT_EQ(share(0, 3, 1, 0) + share(29, 32, 1, 0), 0.0) << "green beside the mark at " << x;
        EXPECT_EQ(share(0, 32, 0, 1), 0.0) << "a red cross at " << x;
    }
}

// Returns a mesh: a profile of (radius, height) turned about the y axis, with smooth normals.
gltf::Primitive turnedProfile(int material, const std::vector<std::array<double, 2>>& profile) {
    constexpr std::uint32_t kSegments = 48;
    gltf::Primitive turned;
    turned.pointer = "/meshes/0/primitives/0";
    turned.material = material;
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const auto& before = profile[i > 0 ? i - 1 : 0];
        const auto& after = profile[std::min(i + 1, profile.size() - 1)];
        const double length = std::hypot(after[0] - before[0], after[1] - before[1]);
        for (std::uint32_t segment = 0; segment <= kSegments; ++segment) {
            const double angle = 2.0 * std::numbers::pi * segment / kSegments;
            const double out = (after[1] - before[1]) / length;
            const auto point = [angle](double radius, double height) {
                return gltf::Float3{static_cast<float>(radius * std::cos(angle)), static_cast<float>(height),
                                    static_cast<float>(-radius * std::sin(angle))};
            };
            turned.positions.push_back(point(profile[i][0], profile[i][1]));
            turned.normals.push_back(point(out, (before[0] - after[0]) / length));
            if (i > 0 && segment > 0) {
                const auto a = static_cast<std::uint32_t>(turned.positions.size()) - 1;
                const std::uint32_t below = a - kSegments - 1;
                turned.indices.insert(turned.indices.end(), {below - 1, below, a, below - 1, a, a - 1});
            }
        }
    }
    return turned;
}

// A vase of smooth glass that is made by BLEND shows what is in it: of its colour, the share that the wall in
// front leaves. Two vases stand far apart, around things of different colours.
TEST(Blend, AVaseShowsTheThingInIt) {
    constexpr float kVaseAlpha = 0.25F;
    gltf::Scene scene = sceneWithCamera();
    materials::Material glass;
    glass["baseColorFactor"] = {0.8F, 0.9F, 1.0F, kVaseAlpha};
    glass["metallicFactor"] = 0.0F;
    glass["roughnessFactor"] = 0.05F;
    glass.alphaMode = materials::AlphaMode::Blend;
    glass.doubleSided = true;
    const int vase = addMesh(
        scene, turnedProfile(addMaterial(scene, glass),
                             {{0.0, -1.0}, {0.5, -1.0}, {0.7, -0.5}, {0.6, 0.2}, {0.4, 0.7}, {0.5, 1.0}}));
    float x = 0.0F;
    for (const gltf::Float3 color : {kRed, kGreen}) {
        gltf::Matrix4 place = scaling(1, 1, 1);
        place[12] = x;
        place[14] = -2.0;
        addInstance(scene, vase, place);
        const int thing = addMaterial(scene, unlitMaterial(color));
        addInstance(scene, addMesh(scene, makeQuad(thing, {-0.2F, -0.4F, 0}, {0.4F, 0, 0}, {0, 0.8F, 0})),
                    place);
        x += kStationDistance;
    }
    compiler::CompileSettings settings = blendSettings();
    settings.strategies = package::kStrategyUber;
    settings.effects = {false, compiler::builtinEffects({"reflection"})};
    // The sky alone lights the vases, because glints of lamps would be noise.
    const LoadedScene loaded(scene, settings, [](session::SceneViewData& data) { data.lights.clear(); });
    RenderSetup setup = squareSetup(scene);
    setup.samples = 64;
    std::array<LinearImage, 2> images;
    for (LinearImage& image : images) {
        image = loaded.render(package::kStrategyUber, setup);
        setup.frame.camera.position[0] += kStationDistance;
    }
    // The thing is 3.2 pixels wide, and 6.4 high.
    double difference = 0.0;
    for (const std::uint32_t column : {15U, 16U}) {
        for (std::uint32_t row = 14; row < 18; ++row) {
            difference += (at(images[0], column, row)[0] - at(images[1], column, row)[0]) / 8.0;
        }
    }
    // The vase's own light is between 0 and 1.5, so that no choice deviates further from a thing.
    const double error = 1.5 * std::sqrt(2.0 * kVaseAlpha * (1.0 - kVaseAlpha) / (8.0 * setup.samples));
    const double contrast = kRed[0] - kGreen[0];
    std::printf("%.4f, expected %.4f ± %.4f\n", difference, (1.0 - kVaseAlpha) * contrast, error);
    EXPECT_NEAR(difference, (1.0 - kVaseAlpha) * contrast, 4.0 * error);
}

// Without BLEND in a scene its package has no code of it.
TEST(Blend, OpaqueLayersArePlannedOpaque) {
    gltf::Scene scene = stackedLayers(false);
    for (materials::Material& material : scene.materials) {
        material["baseColorFactor"][3] = 1.0F;
    }
    const LoadedScene loaded(scene, blendSettings());
    for (const package::PrimitiveEntry& entry : loaded.package().scene(0).primitives) {
        EXPECT_EQ(
            entry.geometryFlags & (gpu::kGeometryBlended | gpu::kGeometryAlphaTested | gpu::kGeometryMasked),
            0U);
    }
}

}  // namespace

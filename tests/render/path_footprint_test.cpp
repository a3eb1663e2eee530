// The width of a path's ray cone after two bounces, which a texture shows whose levels have colours of their
// own, is that of a computation in double precision.
#include "render/harness.h"
#include "render/scene_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <optional>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

using Vector = std::array<double, 3>;

constexpr double kPi = std::numbers::pi;
constexpr std::uint32_t kPixels = 8;
constexpr double kFieldOfView = 0.2;
constexpr double kWallZ = 2.0;
constexpr double kTargetZ = -4.0;
// The side of a texel of the target, in metres, and the levels of its texture.
constexpr double kTexel = 0.05;
constexpr int kLevels = 9;
// kMostPathSpread of shaders/hit/path_sample.glsl.
constexpr double kMostSpread = 0.125;

// A small mirror in front of the camera shows a wall behind it, whose rays go to an endless target beyond the
// mirror. Stations like this stand side by side.
struct Station {
    const char* name;
    double x;
    double tilt;  // of the wall, about the y axis, in radians
    // alpha of the wall's microfacets; a wall without any is diffuse
    std::optional<double> alpha;
};
constexpr Station kStations[] = {
    {"mirror", 0.0, 0.35, 1e-4}, {"glossy", 200.0, 0.35, 0.01}, {"diffuse", 400.0, 0.0, std::nullopt}};

Vector scaledSum(const Vector& a, double factor, const Vector& b) {
    return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

double product(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector normalOf(const Station& station) {
    return {std::sin(station.tilt), 0.0, -std::cos(station.tilt)};
}

std::uint8_t byteOfLevel(int level) {
    return static_cast<std::uint8_t>(40 + 25 * level);
}

// Returns what a level of detail shows: levels are mixed as linear values.
double shownAt(double level) {
    const auto linear = [](int whole) {
        return std::pow((byteOfLevel(std::min(whole, kLevels - 1)) / 255.0 + 0.055) / 1.055, 2.4);
    };
    const double inside = std::clamp(level, 0.0, kLevels - 1.0);
    const int below = static_cast<int>(inside);
    return linear(below) + (inside - below) * (linear(below + 1) - linear(below));
}

// Returns a texture of which red is the level, and green is white.
int addLevels(gltf::Scene& scene) {
    std::vector<std::uint8_t> texels;
    for (int level = 0; level < kLevels; ++level) {
        const int side = 1 << (kLevels - 1 - level);
        for (int i = 0; i < side * side; ++i) {
            texels.insert(texels.end(), {byteOfLevel(level), 255, 0, 255});
        }
    }
    const int texture = addTexture(scene, 1 << (kLevels - 1), 1 << (kLevels - 1), std::move(texels));
    scene.images.back().levels = kLevels;
    // Not trilinear, so that the sampler has no anisotropy.
    scene.samplers.back().mipmapped = true;
    scene.samplers.back().mip = gltf::Filter::Linear;
    return texture;
}

materials::Material wallOf(const Station& station) {
    materials::Material material;
    if (station.alpha) {
        material["roughnessFactor"] =
            static_cast<float>(*station.alpha > 1e-4 ? std::sqrt(*station.alpha) : 0);
    } else {
        material["metallicFactor"] = 0.0F;
        material["specularFactor"] = 0.0F;
    }
    return material;
}

gltf::Scene coneScene() {
    gltf::Scene scene = sceneWithCamera();
    scene.cameras[0].yfov = kFieldOfView;
    const int mirror = addMesh(scene, makeQuad(addMaterial(scene, mirrorMaterial()), {-0.11F, -0.11F, -1},
                                               {0.22F, 0, 0}, {0, 0.22F, 0}));
    for (const Station& station : kStations) {
        gltf::Matrix4 place = scaling(1, 1, 1);
        place[12] = station.x;
        addInstance(scene, mirror, place);
        const Vector n = normalOf(station);
        const auto side = [](double length) { return static_cast<float>(length); };
        // right × up = n
        const gltf::Float3 right{side(n[2]), 0, side(-n[0])};
        const gltf::Float3 corner{-0.5F * right[0], -0.5F, side(kWallZ) - 0.5F * right[2]};
        addInstance(scene,
                    addMesh(scene, makeQuad(addMaterial(scene, wallOf(station)), corner, right, {0, 1, 0})),
                    place);
    }
    materials::Material target;
    target["baseColorFactor"] = {0.0F, 0.0F, 0.0F, 1.0F};
    target["metallicFactor"] = 0.0F;
    target["specularFactor"] = 0.0F;
    target["emissiveFactor"] = {1.0F, 1.0F, 1.0F};
    target.texture("emissiveTexture").texture = addLevels(scene);
    constexpr float kSide = 6000.0F;
    gltf::Primitive quad = makeQuad(addMaterial(scene, target), {-kSide / 2, -kSide / 2, kTargetZ},
                                    {kSide, 0, 0}, {0, kSide, 0});
    for (gltf::Float2& point : quad.texCoords0) {
        for (float& coordinate : point) {
            coordinate *= static_cast<float>(kSide / (kTexel * (1 << (kLevels - 1))));
        }
    }
    addInstance(scene, addMesh(scene, quad));
    return scene;
}

// A direction that a wall sends a ray to, with its weight among others.
struct Sent {
    Vector direction;
    double density;
    double weight;
};

// Returns the direction for two uniform numbers, of a wall that is seen along `view` (away from it). Facets
// are drawn by their own distribution and weighted as the visible ones.
Sent sentBy(const Station& station, const Vector& view, double u, double v) {
    const Vector n = normalOf(station);
    const Vector tangent{n[2], 0.0, -n[0]};
    const double angle = 2.0 * kPi * v;
    const auto around = [&](double cosine) {
        const double sine = std::sqrt(1.0 - cosine * cosine);
        Vector result = scaledSum({}, cosine, n);
        result = scaledSum(result, sine * std::cos(angle), tangent);
        return scaledSum(result, sine * std::sin(angle), {0.0, 1.0, 0.0});
    };
    if (!station.alpha) {
        const double cosine = std::sqrt(1.0 - u);
        return {around(cosine), cosine / kPi, 1.0};
    }
    // Walter et al., "Microfacet Models for Refraction through Rough Surfaces" (2007): D, and G1 of GGX.
    const double alpha2 = *station.alpha * *station.alpha;
    const double cosine2 = (1.0 - u) / (1.0 + (alpha2 - 1.0) * u);
    const Vector facet = around(std::sqrt(cosine2));
    const double base = 1.0 + (alpha2 - 1.0) * cosine2;
    const double distribution = alpha2 / (kPi * base * base);
    const double cosineView = product(n, view);
    const double tan2 = 1.0 / (cosineView * cosineView) - 1.0;
    const double visible = 2.0 / (1.0 + std::sqrt(1.0 + alpha2 * tan2));
    const double cosineFacet = product(facet, view);
    const Vector direction = scaledSum(scaledSum({}, 2.0 * cosineFacet, facet), -1.0, view);
    return {direction, visible * distribution / (4.0 * cosineView),
            visible * cosineFacet / (cosineView * std::sqrt(cosine2))};
}

// Returns the mean of what the rays of all pixels find: each has a cone that is as wide as the widest of the
// cone before, the rays that a sample stands for, and no wider than a limit.
double expectedShown(const Station& station) {
    constexpr int kSteps = 64;
    const double half = std::tan(kFieldOfView / 2.0);
    const double pixelSpread = 2.0 * half / kPixels;
    const Vector n = normalOf(station);
    double sum = 0.0;
    double weights = 0.0;
    for (int pixel = 0; pixel < 16; ++pixel) {
        const double x = half * ((pixel % 4 + 0.5) / 2.0 - 1.0);
        const double y = half * ((pixel / 4 + 0.5) / 2.0 - 1.0);
        const double length = std::sqrt(1.0 + x * x + y * y);
        // The mirror is at z = -1.
        const Vector onMirror{x, y, -1.0};
        const Vector mirrored{x / length, y / length, 1.0 / length};
        const double toWall =
            product(n, scaledSum({0.0, 0.0, kWallZ}, -1.0, onMirror)) / product(n, mirrored);
        const Vector onWall = scaledSum(onMirror, toWall, mirrored);
        const double width = pixelSpread * (length + toWall);
        for (int i = 0; i < kSteps * kSteps; ++i) {
            const Sent sent = sentBy(station, scaledSum({}, -1.0, mirrored), (i % kSteps + 0.5) / kSteps,
                                     (i / kSteps + 0.5) / kSteps);
            const double cosine = -sent.direction[2];
            if (cosine <= 0.0 || product(n, sent.direction) <= 0.0) {
                continue;
            }
            const double distance = (onWall[2] - kTargetZ) / cosine;
            const double spread = std::max(pixelSpread, std::min(kMostSpread, 1.0 / std::sqrt(sent.density)));
            const double texels = (width + spread * distance) / kTexel;
            sum += sent.weight * shownAt(std::log2(texels / std::sqrt(cosine)));
            weights += sent.weight;
        }
    }
    return sum / weights;
}

TEST(PathFootprint, TheConeAfterTwoBouncesIsAnalytic) {
    const gltf::Scene scene = coneScene();
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.maxBounces = 2;
    settings.emissiveLights = compiler::EmissiveLights::Off;
    settings.skyLight = compiler::SkyLight::Off;
    settings.effects = {false, compiler::builtinEffects({"reflection"})};
    settings.plan.merge = compiler::MergePolicy::All;
    settings.energyCompensation = false;
    const LoadedScene loaded(scene, settings, [](session::SceneViewData& data) { data.lights.clear(); });
    RenderSetup setup = defaultSetup(scene, kPixels, kPixels);
    setup.samples = 256;
    setup.frame.averagedSamples = 1;  // cones are as wide as a pixel
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.bounces = 2;
    for (const Station& station : kStations) {
        setup.frame.camera.position[0] = static_cast<float>(station.x);
        const LinearImage image = loaded.render(options, setup);
        double red = 0.0;
        double green = 0.0;
        for (const auto& pixel : image.pixels) {
            red += pixel[0];
            green += pixel[1];
        }
        const double expected = expectedShown(station);
        std::printf("%s: %.5f, expected %.5f\n", station.name, red / green, expected);
        // A level is 0.05 to 0.2 of it.
        EXPECT_NEAR(red / green, expected, 0.004) << station.name;
        EXPECT_GT(green, 0.9 * kPixels * kPixels) << station.name;
    }
}

}  // namespace

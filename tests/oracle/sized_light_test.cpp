// Tests the light of lights that have a size, on surfaces and in a mirror, near the horizon, too.
#include "oracle/comparison.h"
#include "oracle/device.h"
#include "oracle/light.h"
#include "oracle/scene_file.h"
#include "oracle/shading.h"
#include "render/ways.h"
#include "support/effect_bits.h"

#include <algorithm>

namespace {

using namespace glint;
using namespace glint::oracle;
using namespace glint::testing;

constexpr std::uint32_t kSizedWidth = 48;
constexpr std::uint32_t kSizedHeight = 27;
constexpr std::uint32_t kSizedSamples = 256;
constexpr LightSizes kSizes{0.25, 0.4};

enum : int { kSizedWhite, kSizedMetal, kSizedMirror };

// Returns a floor, half white and half of rough metal, before a mirror. The floor hides part of a lamp and of
// a sun.
SceneFile showroom() {
    SceneFile file;
    file.addMaterial(diffuseMaterial());
    file.addMaterial(
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {0.8, 0.8, 0.8, 1.0}}, {"metallicFactor", 1.0}, {"roughnessFactor", 0.5}}}});
    file.addMaterial({{"pbrMetallicRoughness", {{"metallicFactor", 1.0}, {"roughnessFactor", 0.0}}}});
    file.addQuad(kSizedWhite, {-5, 0, 5}, {5, 0, 0}, {0, 0, -10});
    file.addQuad(kSizedMetal, {0, 0, 5}, {5, 0, 0}, {0, 0, -10});
    file.addQuad(kSizedMirror, {-4, 0, -1.5}, {8, 0, 0}, {0, 3, 0});
    file.addCamera({0.2, 0.8, 1.2}, {0, 0.1, -1.5}, 35);
    file.addLight({{"type", "point"}, {"intensity", 1.0}}, {0.1, 0.12, -0.5}, {0, 0, 0});
    file.addLight({{"type", "directional"}, {"intensity", 3.0}}, {3.0, 0.3, 1.0}, {0, 0, 0});
    return file;
}

// Returns the sum of estimates that may share their random numbers.
Estimate sumOf(const Estimate& a, const Estimate& b) {
    const auto deviation = [](const Estimate& e) {
        return glm::sqrt(glm::max(e.square - e.mean * e.mean, Vec3(0.0)));
    };
    const Vec3 mean = a.mean + b.mean;
    const Vec3 both = deviation(a) + deviation(b);
    return {mean, a.error + b.error, mean * mean + both * both};
}

// Returns the light that a point of the floor sends back: on the white half by closed forms, on the metal by
// quadrature over the lights.
Estimate lightFromFloor(const gltf::Scene& scene, const World& world, const Hit& hit, const Ray& ray,
                        Random& random) {
    const Shading shading(scene.materials[static_cast<std::size_t>(hit.material)], hit, ray.direction);
    Estimate sum;
    for (const gltf::Light& light : scene.lights) {
        const LightCap cap = lightCap(light, kSizes, hit.position);
        Estimate own = lightOfCap(
            world, cap, hit.position, [&](const Vec3& toLight) { return shading.scattered(toLight); }, {4, 2},
            random);
        if (hit.material == kSizedWhite) {
            own.mean = Vec3(irradianceAboveHorizon({cap.direction, cap.halfAngle}, hit.normal) / kPi);
            own.error = Vec3(0.0);
        }
        const Vec3 facing = irradianceFrom(light, hit.position);
        sum = sumOf(sum, {own.mean * facing, own.error * facing, own.square * facing * facing});
    }
    return sum;
}

// Returns whether a mirror shows a light along a ray, or nearly so. Their light samples are rarely that
// bright.
bool showsLight(const gltf::Scene& scene, const Ray& ray) {
    for (const gltf::Light& light : scene.lights) {
        const LightCap cap = lightCap(light, kSizes, ray.origin);
        if (glm::dot(cap.direction, ray.direction) > std::cos(cap.halfAngle + 0.2)) {
            return true;
        }
    }
    return false;
}

TEST(SizedLights, LightSurfacesAndWhatAMirrorShows) {
    const gltf::Scene scene = showroom().import();
    const World world(scene);
    // The ray that meets the floor, if the pixel is to be compared: around the lamp the light has a pole.
    const auto toFloor = [&](const Ray& ray, bool inMirror) -> std::optional<Ray> {
        const auto hit = world.closest(ray, Faces::Culled);
        if (!hit || (hit->material == kSizedMirror) != inMirror) {
            return std::nullopt;
        }
        const Ray last = inMirror ? Ray{hit->position, glm::reflect(ray.direction, hit->normal)} : ray;
        const auto floor = inMirror ? world.closest(last, Faces::Culled) : hit;
        if (!floor || glm::length(floor->position - toVec(scene.lights[0].position)) < 0.45 ||
            (inMirror && showsLight(scene, last))) {
            return std::nullopt;
        }
        return last;
    };
    EffectOptions options;
    options.effects = package::kEffectShadow | package::kEffectReflection;
    options.lights = kSizes;
    const LinearImage image =
        renderEffect(scene, options, setupOf(scene, kSizedWidth, kSizedHeight, kSizedSamples, {}));
    for (const bool inMirror : {false, true}) {
        for (const int material : {kSizedWhite, kSizedMetal}) {
            const std::string where = std::string(material == kSizedWhite ? "white" : "rough metal") +
                                      (inMirror ? " in a mirror" : "");
            SCOPED_TRACE(where);
            const auto truths = pixelTruths(
                View(scene.cameras.at(0), kSizedWidth, kSizedHeight), {4, 4},
                [&](const Ray& ray) {
                    const auto last = toFloor(ray, inMirror);
                    return last && world.closest(*last, Faces::Culled)->material == material;
                },
                [&](const Ray& ray, Random& random) {
                    const Ray last = *toFloor(ray, inMirror);
                    return lightFromFloor(scene, world, *world.closest(last, Faces::Culled), last, random);
                });
            EXPECT_GT(truths.size(), 60U);
            expectAgrees(
                image, truths,
                {inMirror ? "shadow, reflection" : "shadow", "a lamp and a sun at the horizon, " + where,
                 material == kSizedWhite ? "arcs of circles" : "quadrature", 1, samplesOf(kSizedSamples),
                 20.0, 2e-4});
        }
    }
}

// Returns the light of all lights that a ray meets before a surface.
Vec3 lightsAlong(const gltf::Scene& scene, const World& world, const Ray& ray) {
    Vec3 sum(0.0);
    for (const gltf::Light& light : scene.lights) {
        const LightCap cap = lightCap(light, kSizes, ray.origin);
        const bool meets = glm::dot(cap.direction, ray.direction) > std::cos(cap.halfAngle);
        if (meets && world.visible(ray, cap.distanceAlong(ray.direction))) {
            const double sine = std::sin(cap.halfAngle);
            sum += irradianceFrom(light, ray.origin) / (kPi * sine * sine);
        }
    }
    return sum;
}

// Rays of lobes find a lamp, a spot and a sun, which a block hides in part.
TEST(SizedLights, AreSeenInAMirror) {
    SceneFile file;
    file.addMaterial({{"pbrMetallicRoughness", {{"metallicFactor", 1.0}, {"roughnessFactor", 0.0}}}});
    file.addMaterial(unlitMaterial(Vec3(0.0)));
    file.addQuad(0, {-4, -2, -1.5}, {8, 0, 0}, {0, 4, 0});
    file.addQuad(1, {0.0, -0.3, -0.3}, {0.3, 0, 0}, {0, 1.0, 0});
    file.addQuad(1, {0.3, -0.3, -0.3}, {-0.3, 0, 0}, {0, 1.0, 0});
    file.addCamera({0.2, 0.4, 1.2}, {0, 0.1, -1.5}, 60);
    file.addLight({{"type", "point"}, {"intensity", 1.0}, {"range", 4.0}}, {0.1, 0.12, 0.1}, {0, 0, 0});
    file.addLight({{"type", "spot"},
                   {"intensity", 2.0},
                   {"color", {1.0, 0.5, 0.25}},
                   {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.6}}}},
                  {-0.6, 0.3, 0.3}, {-0.6, 0.3, -1.5});
    file.addLight({{"type", "directional"}, {"intensity", 3.0}}, {1.0, 0.6, 3.0}, {0, 0, 0});
    const gltf::Scene scene = file.import();
    const World world(scene);
    EffectOptions options;
    options.effects = package::kEffectShadow | package::kEffectReflection;
    options.lights = kSizes;
    options.findsLights = true;
    RenderSetup setup = setupOf(scene, kSizedWidth, kSizedHeight, 1, {});
    setup.samples = 1;
    const auto truths =
        centreTruths(View(scene.cameras.at(0), kSizedWidth, kSizedHeight), [&](const Ray& ray) {
            const auto hit = world.closest(ray, Faces::Culled);
            return hit && hit->material == 0
                       ? lightsAlong(scene, world, {hit->position, glm::reflect(ray.direction, hit->normal)})
                       : Vec3(0.0);
        });
    EXPECT_GT(truths.size(), std::size_t{kSizedWidth} * kSizedHeight * 8 / 10);
    EXPECT_GT(std::ranges::count_if(truths, [](const PixelTruth& truth) { return truth.light.mean.x > 0.1; }),
              60);
    expectAgrees(
        renderEffect(scene, options, setup), truths,
        {"shadow, reflection", "a lamp, a spot and a sun in a mirror", "closed form", 3, 1, 1e-9, 1e-4});
}

TEST(SizedLights, LookTheSameWithEveryStrategy) {
    const gltf::Scene scene = showroom().import();
    compiler::CompileSettings settings;
    settings.effects = {false, package::kEffectShadow | package::kEffectReflection, 0.0F};
    RenderSetup setup = setupOf(scene, kSizedWidth, kSizedHeight, 4, {});
    setup.frame.shadowSamples = 3;
    LinearImage reference;
    forEachWay(
        scene, settings,
        [&](const LoadedScene& loaded, const Way& way) {
            const LinearImage image = loaded.render(optionsOf(way), setup);
            if (reference.pixels.empty()) {
                reference = image;
            }
            expectSameImage(image, reference, nameOf(way));
        },
        [](session::SceneViewData& data) {
            for (LightView& light : data.lights) {
                const bool sun = light.type == LightView::Type::Directional;
                light.size = static_cast<float>(sun ? 0.5 * kSizes.sunDiameter : kSizes.radius);
            }
        });
}

}  // namespace

// Tests shadows of lights with a size, by the device and by the oracle.
#include "oracle/comparison.h"
#include "oracle/device.h"
#include "oracle/light.h"
#include "oracle/scene_file.h"
#include "support/effect_bits.h"

namespace {

using namespace glint;
using namespace glint::oracle;
using namespace glint::testing;

constexpr std::uint32_t kSoftShadowWidth = 48;
constexpr std::uint32_t kSoftShadowHeight = 27;
constexpr std::uint32_t kSoftShadowSamples = 512;
constexpr double kSunDegrees = 24.0;
constexpr double kDisk = 0.5;
constexpr double kDiskHeight = 1.0;

// Returns a disk over a floor, both white and lit from both sides. The camera looks below the disk.
SceneFile diskOverFloor() {
    SceneFile file;
    const int white = file.addMaterial(diffuseMaterial(Vec3(1.0), true));
    file.addQuad(white, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
    file.addDisk(white, {0, kDiskHeight, 0}, {0, 1, 0}, kDisk, 128);
    file.addCamera({0.2, 1.2, 3.0}, {0.3, 0.0, 0.25}, 15);
    return file;
}

// Returns the light that a white point of the floor shows: its irradiance over π. `share` is the irradiance
// over that on a surface which faces the light.
Estimate lit(const gltf::Light& light, const Hit& hit, const Estimate& share) {
    const Vec3 whole = irradianceFrom(light, hit.position) / kPi;
    return {share.mean * whole, share.error * whole, share.square * whole * whole};
}

// Returns the truths of the floor.
std::vector<PixelTruth> truths(const gltf::Scene& scene, const World& world, const Strata& strata,
                               const std::function<Estimate(const Hit&, Random&)>& light) {
    return pixelTruths(
        View(scene.cameras.at(0), kSoftShadowWidth, kSoftShadowHeight), strata,
        [&](const Ray& ray) { return world.meetsGround(ray); },
        [&](const Ray& ray, Random& random) { return light(*world.closest(ray, Faces::Culled), random); });
}

std::vector<PixelTruth> byQuadrature(const gltf::Scene& scene, const World& world, const LightSizes& sizes) {
    return truths(scene, world, {6, 4}, [&](const Hit& hit, Random& random) {
        const LightCap cap = lightCap(scene.lights[0], sizes, hit.position);
        return lit(scene.lights[0], hit,
                   irradianceOfCap(world, cap, hit.position, hit.normal, {3, 2}, random));
    });
}

LinearImage render(const gltf::Scene& scene, const LightSizes& sizes, std::uint32_t raysPerSample = 1,
                   std::uint32_t more = 0) {
    EffectOptions options;
    options.effects = package::kEffectShadow | more;
    options.lights = sizes;
    options.shadowRays = raysPerSample;
    return renderEffect(
        scene, options,
        setupOf(scene, kSoftShadowWidth, kSoftShadowHeight, kSoftShadowSamples / raysPerSample, {}));
}

TEST(SoftShadow, OfADiskUnderTheSun) {
    SceneFile file = diskOverFloor();
    file.addLight({{"type", "directional"}, {"intensity", kPi}}, {0, 3, 0}, {0, 0, 0});
    const gltf::Scene scene = file.import();
    const World world(scene);
    const LightSizes sizes{0.0, kSunDegrees * kPi / 180.0};
    const LinearImage image = render(scene, sizes);
    expectAgrees(
        image, byQuadrature(scene, world, sizes),
        {"shadow", "a disk under a sun of 24°", "quadrature", 1, samplesOf(kSoftShadowSamples), 1.0, 1e-4});
    const auto closed = truths(scene, world, {5, 4}, [&](const Hit& hit, Random&) {
        const double aside = std::hypot(hit.position.x, hit.position.z) / kDiskHeight;
        const double share = irradianceBesidesDisk(0.5 * sizes.sunDiameter, kDisk / kDiskHeight, aside);
        return lit(scene.lights[0], hit, {Vec3(share), Vec3(0.0), Vec3(share)});
    });
    // The polygon's outline is within 4e-4 of the disk's radius.
    expectAgrees(image, closed,
                 {"shadow", "a disk under a sun of 24°", "arcs of circles", 1, samplesOf(kSoftShadowSamples),
                  1.0, 3e-4});
}

TEST(SoftShadow, OfADiskUnderALamp) {
    for (const bool spot : {false, true}) {
        SceneFile file = diskOverFloor();
        Json light{{"type", spot ? "spot" : "point"}, {"intensity", 4.0 * kPi}};
        if (spot) {
            light["spot"] = {{"innerConeAngle", 0.4}, {"outerConeAngle", 0.8}};
        }
        file.addLight(light, {0.4, 2.0, 0.3}, {0, 0, 0});
        const gltf::Scene scene = file.import();
        const LightSizes sizes{0.3, 0.0};
        expectAgrees(render(scene, sizes, spot ? 2 : 1), byQuadrature(scene, World(scene), sizes),
                     {"shadow",
                      spot ? "a disk under a spot of radius 0.3 m, two rays a sample"
                           : "a disk under a lamp of radius 0.3 m",
                      "quadrature", 1, samplesOf(kSoftShadowSamples), 1.2, 1e-4});
    }
}

// A hit of a ray takes one ray to the light; here it is the floor that a mirror shows.
TEST(SoftShadow, OfADiskInAMirror) {
    SceneFile file;
    const int white = file.addMaterial(diffuseMaterial(Vec3(1.0), true));
    const int mirror =
        file.addMaterial({{"pbrMetallicRoughness", {{"metallicFactor", 1.0}, {"roughnessFactor", 0.0}}}});
    file.addQuad(white, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
    file.addDisk(white, {0, kDiskHeight, 0}, {0, 1, 0}, kDisk, 128);
    file.addQuad(mirror, {-4, 0, -1.5}, {8, 0, 0}, {0, 3, 0});
    file.addCamera({0.2, 0.8, 1.2}, {0, 0.1, -1.5}, 35);
    file.addLight({{"type", "point"}, {"intensity", 4.0 * kPi}}, {0.4, 2.0, 0.3}, {0, 0, 0});
    const gltf::Scene scene = file.import();
    const World world(scene);
    const LightSizes sizes{0.3, 0.0};
    const auto reflected = [&](const Ray& ray) -> std::optional<Ray> {
        const std::optional<Hit> hit = world.closest(ray, Faces::Culled);
        if (!hit || hit->material != mirror) {
            return std::nullopt;
        }
        return Ray{hit->position, glm::reflect(ray.direction, hit->normal)};
    };
    const auto truths = pixelTruths(
        View(scene.cameras.at(0), kSoftShadowWidth, kSoftShadowHeight), {6, 4},
        [&](const Ray& ray) {
            const std::optional<Ray> onwards = reflected(ray);
            return onwards && world.meetsGround(*onwards);
        },
        [&](const Ray& ray, Random& random) {
            const Hit hit = *world.closest(*reflected(ray), Faces::Culled);
            const LightCap cap = lightCap(scene.lights[0], sizes, hit.position);
            return lit(scene.lights[0], hit,
                       irradianceOfCap(world, cap, hit.position, hit.normal, {3, 2}, random));
        });
    EXPECT_GT(truths.size(), 200U);
    expectAgrees(render(scene, sizes, 1, package::kEffectReflection), truths,
                 {"shadow, reflection", "a disk under a lamp of radius 0.3 m, in a mirror", "quadrature", 1,
                  samplesOf(kSoftShadowSamples), 1.2, 1e-4});
}

TEST(SoftShadow, OfASphereUnderTheSun) {
    SceneFile file;
    const int white = file.addMaterial(diffuseMaterial());
    file.addQuad(white, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
    constexpr Vec3 kBallCenter(0, 1.2, 0);
    file.addSphere(white, kBallCenter, 0.4, 96);
    file.addCamera({0.2, 1.2, 3.0}, {-0.2, 0.0, 0.0}, 18);
    const Vec3 toSun = glm::normalize(Vec3(0.3, 1.0, 0.2));
    file.addLight({{"type", "directional"}, {"intensity", kPi}}, toSun, {0, 0, 0});
    const gltf::Scene scene = file.import();
    const World world(scene);
    const LightSizes sizes{0.0, kSunDegrees * kPi / 180.0};
    const auto closed = truths(scene, world, {5, 4}, [&](const Hit& hit, Random&) {
        const Vec3 toCenter = kBallCenter - hit.position;
        const double distance = glm::length(toCenter);
        const double share = irradianceBesides({toSun, 0.5 * sizes.sunDiameter},
                                               {toCenter / distance, std::asin(0.4 / distance)}, hit.normal);
        // All of the sun has nearly the cosine of its centre.
        const Vec3 square(share * glm::dot(hit.normal, toSun));
        return lit(scene.lights[0], hit, {Vec3(share), Vec3(0.0), square});
    });
    expectAgrees(render(scene, sizes), closed,
                 {"shadow", "a sphere under a sun of 24°", "lens of two caps", 1,
                  samplesOf(kSoftShadowSamples), 1.0, 3e-4});
}

}  // namespace

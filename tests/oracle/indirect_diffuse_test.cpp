// Tests one bounce of light, by the device and by the oracle.
#include "oracle/comparison.h"
#include "oracle/device.h"
#include "oracle/irradiance.h"
#include "oracle/light.h"
#include "oracle/scene_file.h"
#include "support/effect_bits.h"

namespace {

using namespace glint;
using namespace glint::oracle;
using namespace glint::testing;

constexpr std::uint32_t kIndirectDiffuseWidth = 48;
constexpr std::uint32_t kIndirectDiffuseHeight = 27;
constexpr std::uint32_t kIndirectDiffuseSamples = 256;
constexpr Vec3 kLow(-1, 0, -1);
constexpr Vec3 kHigh(1, 2, 1);

// The materials of a room whose surfaces reflect diffusely.
struct Room {
    std::vector<Vec3> albedos;
    std::vector<Vec3> emissions;

    Vec3 albedo(const Hit& hit) const {
        return albedos[static_cast<std::size_t>(hit.material)];
    }
    Vec3 emission(const Hit& hit) const {
        return emissions[static_cast<std::size_t>(hit.material)];
    }
    int add(SceneFile& file, const Vec3& albedo, const Vec3& emission = Vec3(0.0)) {
        albedos.push_back(albedo);
        emissions.push_back(emission);
        return file.addMaterial(emission == Vec3(0.0) ? diffuseMaterial(albedo) : emissiveMaterial(emission));
    }
};

EffectOptions indirectDiffuse(unsigned more = 0) {
    EffectOptions options;
    options.effects = package::kEffectIndirectDiffuse | more;
    return options;
}

// Returns the light that leaves a surface from its direct light: emission, a lamp with its hard shadow, and a
// uniform sky that hits treat as unoccluded.
Vec3 firstHand(const World& world, const gltf::Scene& scene, const Room& room, double sky, const Hit& hit) {
    Vec3 arriving(sky);
    for (const gltf::Light& light : scene.lights) {
        const LightCap cap = lightCap(light, {}, hit.position);
        const double cosine = glm::dot(hit.normal, cap.direction);
        if (cosine > 0.0 && light.intensity > 0.0F &&
            world.visible({hit.position, cap.direction}, cap.centerDistance)) {
            arriving += irradianceFrom(light, hit.position) * (cosine / kPi);
        }
    }
    return room.emission(hit) + room.albedo(hit) * arriving;
}

Selector meets(const World& world) {
    return [&world](const Ray& ray) { return world.closest(ray, Faces::Culled).has_value(); };
}

// Returns each pixel's light: its own, and one bounce instead of the sky's light.
std::vector<PixelTruth> byQuadrature(const gltf::Scene& scene, const Room& room, double sky) {
    const World world(scene);
    return pixelTruths(
        View(scene.cameras.at(0), kIndirectDiffuseWidth, kIndirectDiffuseHeight), {6, 4}, meets(world),
        [&](const Ray& ray, Random& random) {
            const Hit hit = *world.closest(ray, Faces::Culled);
            Estimate light = irradianceOverPi(
                world, hit.position, hit.normal, Faces::Culled,
                [&](const Hit& found, const Ray&) { return firstHand(world, scene, room, sky, found); },
                [&](const Vec3&) { return Vec3(sky); }, {3, 2}, random);
            const Vec3 albedo = room.albedo(hit);
            const Vec3 own = firstHand(world, scene, room, 0.0, hit);
            light.square = own * own + 2.0 * own * albedo * light.mean + albedo * albedo * light.square;
            light.mean = own + albedo * light.mean;
            return light;
        });
}

LinearImage render(const gltf::Scene& scene, const EffectOptions& options, double sky) {
    return renderEffect(scene, options,
                        setupOf(scene, kIndirectDiffuseWidth, kIndirectDiffuseHeight, kIndirectDiffuseSamples,
                                {Vec3(sky), Vec3(sky), Vec3(sky)}));
}

// Every ray finds a wall that shows the sky's light once: albedo² of it, without noise.
TEST(IndirectDiffuse, OfAClosedWhiteBoxUnderTheSkyIsExact) {
    SceneFile file;
    Room room;
    const int white = room.add(file, Vec3(0.8));
    file.addBox(std::vector<int>(6, white), kLow, kHigh, true);
    file.addCamera({0.3, 0.7, 0.95}, {-0.2, 1.0, -1}, 70);
    file.addDarkness();
    const gltf::Scene scene = file.import();
    const World world(scene);
    const auto truths = pixelTruths(View(scene.cameras.at(0), kIndirectDiffuseWidth, kIndirectDiffuseHeight),
                                    {1, 2}, meets(world), [](const Ray&, Random&) {
                                        return Estimate{Vec3(0.64), Vec3(0.0), Vec3(0.64 * 0.64)};
                                    });
    RenderSetup setup = setupOf(scene, kIndirectDiffuseWidth, kIndirectDiffuseHeight, kIndirectDiffuseSamples,
                                {Vec3(1.0), Vec3(1.0), Vec3(1.0)});
    // This number of samples is fixed: of about 10⁵ rays, one that starts where two walls meet leaves the
    // box.
    setup.samples = 16;
    expectAgrees(renderEffect(scene, indirectDiffuse(), setup), truths,
                 {"indirect-diffuse", "a closed box of albedo 0.8 under a sky of 1", "albedo²", 1,
                  setup.samples, 0.0, 0.0});
}

TEST(IndirectDiffuse, OfABrightCeilingIsItsFormFactor) {
    SceneFile file;
    Room room;
    const int white = room.add(file, Vec3(0.8));
    const int red = room.add(file, {0.7, 0.2, 0.1});
    const int bright = room.add(file, Vec3(0.0), {3.0, 2.0, 1.0});
    file.addBox({red, white, white, bright, white, white}, kLow, kHigh, true);
    file.addCamera({0.3, 1.2, 0.95}, {-0.2, 0.5, -1}, 70);
    file.addDarkness();
    const gltf::Scene scene = file.import();
    const LinearImage image = render(scene, indirectDiffuse(), 0.0);
    expectAgrees(image, byQuadrature(scene, room, 0.0),
                 {"indirect-diffuse", "a box with a bright ceiling", "quadrature", 3,
                  samplesOf(kIndirectDiffuseSamples), 3.0, 0.0});
    const World world(scene);
    const auto closed = pixelTruths(
        View(scene.cameras.at(0), kIndirectDiffuseWidth, kIndirectDiffuseHeight), {8, 4},
        [&](const Ray& ray) { return world.meetsGround(ray); },
        [&](const Ray& ray, Random&) {
            const Hit hit = *world.closest(ray, Faces::Culled);
            const double factor = formFactorOfQuad(hit.position, hit.normal, {kLow.x, kHigh.y, kLow.z},
                                                   {kHigh.x - kLow.x, 0, 0}, {0, 0, kHigh.z - kLow.z});
            const Vec3 whole = room.albedo(hit) * Vec3(3.0, 2.0, 1.0);
            return Estimate{whole * factor, Vec3(0.0), whole * whole * factor};
        });
    EXPECT_GT(closed.size(), 150U);
    expectAgrees(image, closed,
                 {"indirect-diffuse", "its floor", "Lambert's formula", 3, samplesOf(kIndirectDiffuseSamples),
                  3.0, 0.0});
}

// Walls lit by a lamp light each other. A block casts a shadow that the bounce sees.
TEST(IndirectDiffuse, OfARoomWithALamp) {
    SceneFile file;
    Room room;
    const int white = room.add(file, Vec3(0.8));
    const int red = room.add(file, {0.8, 0.1, 0.1});
    const int green = room.add(file, {0.1, 0.8, 0.1});
    file.addBox({red, green, white, white, white, white}, kLow, kHigh, true);
    file.addBox(std::vector<int>(6, white), {-0.4, 0.0, -0.6}, {0.2, 0.7, 0.0}, false);
    file.addLight({{"type", "point"}, {"intensity", 2.0}}, {0.3, 1.5, 0.2}, {0, 0, 0});
    file.addCamera({0.1, 1.1, 0.95}, {-0.1, 0.7, -1}, 75);
    const gltf::Scene scene = file.import();
    expectAgrees(render(scene, indirectDiffuse(package::kEffectShadow), 0.0), byQuadrature(scene, room, 0.0),
                 {"indirect-diffuse", "a room with a lamp and a block", "quadrature", 3,
                  samplesOf(kIndirectDiffuseSamples), 2.5, 2e-4});
}

// Under a sky, rays that miss bring the sky, and hits show the sky's light without a second bounce.
TEST(IndirectDiffuse, OfABlockUnderTheSky) {
    SceneFile file;
    Room room;
    const int white = room.add(file, Vec3(0.8));
    const int red = room.add(file, {0.8, 0.2, 0.1});
    file.addQuad(white, {-6, 0, 6}, {12, 0, 0}, {0, 0, -12});
    file.addBox(std::vector<int>(6, red), {-0.5, 0.0, -0.5}, {0.5, 1.0, 0.5}, false);
    file.addCamera({1.6, 1.8, 2.2}, {0, 0.3, 0}, 40);
    file.addDarkness();
    const gltf::Scene scene = file.import();
    expectAgrees(render(scene, indirectDiffuse(), 1.0), byQuadrature(scene, room, 1.0),
                 {"indirect-diffuse", "a red block under a sky of 1", "quadrature", 3,
                  samplesOf(kIndirectDiffuseSamples), 0.8, 1e-4});
}

}  // namespace

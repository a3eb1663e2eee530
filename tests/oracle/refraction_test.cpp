// Tests light through glass: a random walk on the device against the oracle's sum of all paths.
#include "oracle/refraction.h"

#include "oracle/comparison.h"
#include "oracle/device.h"
#include "oracle/scene_file.h"
#include "support/effect_bits.h"

namespace {

using namespace glint;
using namespace glint::oracle;
using namespace glint::testing;

constexpr std::uint32_t kRefractionWidth = 48;
constexpr std::uint32_t kRefractionHeight = 27;
constexpr std::uint32_t kRefractionSamples = 256;

// Adds an unlit floor of this half width whose colour is linear in x and z, so that it tells where a ray
// arrives. The sky is black.
void addFloor(SceneFile& file, double half) {
    file.addColoredQuad(file.addMaterial(unlitMaterial()), {-half, 0, half}, {2 * half, 0, 0},
                        {0, 0, -2 * half},
                        {{0.0, 0.4, 1.0}, {1.0, 0.4, 1.0}, {1.0, 0.4, 0.0}, {0.0, 0.4, 0.0}});
}

Vec3 black(const Vec3& /*direction*/) {
    return Vec3(0.0);
}

Vec3 floorColor(const Hit& hit, const Ray& /*ray*/) {
    return hit.color;
}

bool isOf(const World& world, const Ray& ray, int material) {
    const std::optional<Hit> hit = world.closest(ray, Faces::Culled);
    return hit && hit->material == material;
}

// Returns pixels that glass fills and whose omitted paths are worth less than 1e-4. `spread` is the factor of
// the variance of a walk with one wavelength over a walk with all.
std::vector<PixelTruth> throughGlass(const View& view, const World& world, int glassMaterial,
                                     const Dielectric& glass, double spread = 1.0) {
    const DielectricOf dielectricOf = [&](int material) {
        return material == glassMaterial ? &glass : nullptr;
    };
    RefractionSettings settings;
    settings.minWeight = 1e-6;
    const auto selected = [&](const Ray& ray) { return isOf(world, ray, glassMaterial); };
    std::vector<PixelTruth> truths =
        pixelTruths(view, {5, 4}, selected, [&](const Ray& ray, Random&) -> Estimate {
            const Hit hit = *world.closest(ray, Faces::Culled);
            const RefractedLight light =
                refractedLight(world, ray, hit, dielectricOf, floorColor, black, settings);
            if (std::max({light.left.x, light.left.y, light.left.z}) > 1e-4) {
                return {Vec3(std::numeric_limits<double>::quiet_NaN()), Vec3(0.0), Vec3(0.0)};
            }
            return {light.radiance, Vec3(0.0), spread * light.square};
        });
    std::erase_if(truths, [](const PixelTruth& truth) { return std::isnan(truth.light.mean.x); });
    return truths;
}

LinearImage render(const gltf::Scene& scene, bool energyCompensation = true) {
    EffectOptions options;
    options.energyCompensation = energyCompensation;
    options.effects = package::kEffectRefraction;
    return renderEffect(scene, options,
                        setupOf(scene, kRefractionWidth, kRefractionHeight, kRefractionSamples, {}));
}

// Tests Snell's displacement and Beer's path.
TEST(Refraction, OfASlab) {
    for (const bool clear : {true, false}) {
        SceneFile file;
        addFloor(file, 2.5);
        Glass glass{1.5, 1.0, 0.5, {0.3, 0.6, 0.9}, 0.0};
        if (clear) {
            glass.attenuationDistance = 0.0;
        }
        const int material = file.addMaterial(glassMaterial(glass));
        file.addBox(std::vector<int>(6, material), {-2, 0.3, -2}, {2, 1.1, 2}, false);
        file.addCamera({0.3, 3.2, 4.0}, {0, 0.7, 0}, 20);
        file.addDarkness();
        const gltf::Scene scene = file.import();
        const Dielectric dielectric{Vec3(1.5), clear ? Vec3(0.0) : absorptionOf({0.3, 0.6, 0.9}, 0.5)};
        const auto truths = throughGlass(View(scene.cameras.at(0), kRefractionWidth, kRefractionHeight),
                                         World(scene), material, dielectric);
        EXPECT_GT(truths.size(), 400U);
        expectAgrees(render(scene), truths,
                     {"refraction", clear ? "a slab of index 1.5" : "a slab that absorbs", "sum of paths", 3,
                      samplesOf(kRefractionSamples), 1.0, 1e-4});
    }
}

TEST(Refraction, OfASphere) {
    SceneFile file;
    addFloor(file, 4.0);
    const Glass glass{1.5, 1.0, 0.8, {0.9, 0.7, 0.4}, 0.0};
    const int material = file.addMaterial(glassMaterial(glass));
    const Vec3 center(0, 1.2, 0);
    file.addSphere(material, center, 0.8, 128);
    file.addCamera({0.5, 2.5, 3.0}, {0, 1.1, 0}, 32);
    file.addDarkness();
    const gltf::Scene scene = file.import();
    const Dielectric dielectric{Vec3(1.5), absorptionOf({0.9, 0.7, 0.4}, 0.8)};
    const View view(scene.cameras.at(0), kRefractionWidth, kRefractionHeight);
    const LinearImage image = render(scene);
    const auto facets = throughGlass(view, World(scene), material, dielectric);
    EXPECT_GT(facets.size(), 300U);
    expectAgrees(image, facets,
                 {"refraction", "a sphere that absorbs, of facets", "sum of paths", 3,
                  samplesOf(kRefractionSamples), 1.0, 3e-4});
    // The second sphere has no facets.
    SceneFile without;
    addFloor(without, 4.0);
    World world(without.import());
    world.addSphere(center, 0.8, material);
    expectAgrees(
        image, throughGlass(view, world, material, dielectric),
        {"refraction", "the same", "sum of paths, no facets", 3, samplesOf(kRefractionSamples), 1.0, 2e-3});
}

// KHR_materials_dispersion: red, green and blue have their own indices, and each wavelength its own way. The
// prism's sides are left out, and light that goes there is lost.
TEST(Refraction, OfAPrism) {
    SceneFile file;
    addFloor(file, 1.5);
    const Glass glass{1.6, 1.0, 0.0, Vec3(1.0), 10.0};
    const int material = file.addMaterial(glassMaterial(glass));
    file.addQuad(material, {-1, 2, 1}, {2, 0, 0}, {0, 0, -2});
    // The face goes from x = -1, y = 0.9 to x = 1, y = 1.9, which is 27°.
    file.addQuad(material, {-1, 0.9, -1}, {2, 1, 0}, {0, 0, 2});
    file.addCamera({0.0, 5.0, 0.5}, {0, 2, 0}, 20);
    file.addDarkness();
    const gltf::Scene scene = file.import();
    const double half = (1.6 - 1.0) * 0.025 * 10.0;
    const Dielectric dielectric{Vec3(1.6 - half, 1.6, 1.6 + half), Vec3(0.0), 1.6};
    const auto truths = throughGlass(View(scene.cameras.at(0), kRefractionWidth, kRefractionHeight),
                                     World(scene), material, dielectric, 3.0);
    EXPECT_GT(truths.size(), 1000U);
    expectAgrees(render(scene), truths,
                 {"refraction", "a prism of dispersion 10", "sum of paths", 3, samplesOf(kRefractionSamples),
                  3.0, 3e-4});
}

// There is one rough interface: the surface of a pool whose ground is in the medium.
TEST(Refraction, OfARoughSurface) {
    for (const double roughness : {0.3, 0.6}) {
        SceneFile file;
        addFloor(file, 10.0);
        const Glass glass{1.33, 1.0, 1.0, {0.4, 0.7, 0.8}, 0.0};
        Json json = glassMaterial(glass);
        json["pbrMetallicRoughness"]["roughnessFactor"] = roughness;
        const int material = file.addMaterial(json);
        file.addQuad(material, {-9, 1, 9}, {18, 0, 0}, {0, 0, -18});
        file.addCamera({0.5, 4.0, 3.5}, {0, 0.8, 0}, 35);
        file.addDarkness();
        const gltf::Scene scene = file.import();
        const World world(scene);
        const Dielectric dielectric{Vec3(1.33), absorptionOf({0.4, 0.7, 0.8}, 1.0)};
        const auto truths = pixelTruths(
            View(scene.cameras.at(0), kRefractionWidth, kRefractionHeight), {3, 4},
            [&](const Ray& ray) { return isOf(world, ray, material); },
            [&](const Ray& ray, Random& random) {
                return roughlyRefractedLight(world, ray, *world.closest(ray, Faces::Culled),
                                             roughness * roughness, dielectric, Fresnel::Schlick, floorColor,
                                             black, {3, 2}, random);
            });
        EXPECT_GT(truths.size(), 400U);
        // The truth follows light that one facet sends, without what others block.
        expectAgrees(render(scene, false), truths,
                     {"refraction", roughness < 0.5 ? "a pool of roughness 0.3" : "a pool of roughness 0.6",
                      "visible normals", 3, samplesOf(kRefractionSamples), 1.0, 2e-4});
    }
}

// A thin wall transmits what it does not reflect, without bending it.
TEST(Refraction, OfAThinWall) {
    SceneFile file;
    addFloor(file, 10.0);
    Glass glass;
    glass.thickness = 0.0;
    Json json = glassMaterial(glass);
    json["pbrMetallicRoughness"]["baseColorFactor"] = {0.9, 0.6, 0.3, 1.0};
    const int material = file.addMaterial(json);
    file.addQuad(material, {-2, 1, 2}, {4, 0, 0}, {0, 0, -4});
    file.addCamera({0.5, 4.0, 3.5}, {0, 0.8, 0}, 35);
    file.addDarkness();
    const gltf::Scene scene = file.import();
    const World world(scene);
    const auto truths = pixelTruths(
        View(scene.cameras.at(0), kRefractionWidth, kRefractionHeight), {6, 4},
        [&](const Ray& ray) { return isOf(world, ray, material); },
        [&](const Ray& ray, Random&) {
            const Hit hit = *world.closest(ray, Faces::Culled);
            const double reflects =
                reflectance(Fresnel::Schlick, 1.0, 1.5, -glm::dot(ray.direction, hit.normal));
            const std::optional<Hit> behind = world.closest({hit.position, ray.direction}, Faces::Culled);
            const Vec3 light = (1.0 - reflects) * Vec3(0.9, 0.6, 0.3) * (behind ? behind->color : Vec3(0.0));
            return Estimate{light, Vec3(0.0), light * light};
        });
    EXPECT_GT(truths.size(), 400U);
    expectAgrees(render(scene), truths,
                 {"refraction", "a thin wall, tinted", "(1 - F) of what is behind", 3,
                  samplesOf(kRefractionSamples), 0.0, 1e-4});
}

}  // namespace

// Compares whole pictures of direct light and mirrors with the reference renderer.
#include "oracle/reference.h"

#include "oracle/comparison.h"
#include "oracle/device.h"
#include "oracle/scene_file.h"
#include "support/effect_bits.h"

namespace {

using namespace glint;
using namespace glint::oracle;
using namespace glint::testing;

constexpr std::uint32_t kReferenceWidth = 64;
constexpr std::uint32_t kReferenceHeight = 36;
constexpr std::uint32_t kReferenceSamples = 256;
// The error that single precision of positions and normals causes at highlights and silhouettes; at most 3e-4
// was measured.
constexpr double kSinglePrecision = 5e-4;

Json material(const Vec3& color, double metallic, double roughness) {
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", {color.x, color.y, color.z, 1.0}},
              {"metallicFactor", metallic},
              {"roughnessFactor", roughness}}}};
}

// Returns six spheres with different materials on a floor.
SceneFile spheresOnFloor(const Json& floor) {
    SceneFile file;
    Json coated = material({0.6, 0.1, 0.1}, 0.0, 0.6);
    coated["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 0.8},
                                                       {"clearcoatRoughnessFactor", 0.3}};
    coated["emissiveFactor"] = {0.05, 0.02, 0.1};
    Json velvet = material({0.1, 0.1, 0.4}, 0.0, 0.8);
    velvet["extensions"]["KHR_materials_sheen"] = {{"sheenColorFactor", {0.8, 0.6, 0.9}},
                                                   {"sheenRoughnessFactor", 0.5}};
    Json tinted = material({0.2, 0.5, 0.2}, 0.0, 0.4);
    tinted["extensions"]["KHR_materials_specular"] = {{"specularFactor", 0.7},
                                                      {"specularColorFactor", {1.0, 0.5, 0.2}}};
    tinted["extensions"]["KHR_materials_ior"] = {{"ior", 1.9}};
    const std::vector<Json> all{
        material({0.9, 0.6, 0.3}, 1.0, 0.35), coated, velvet, tinted, material({0.8, 0.8, 0.8}, 0.0, 0.5),
        material({0.7, 0.7, 0.9}, 0.5, 0.7)};
    file.addQuad(file.addMaterial(floor), {-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double x = -1.5 + 1.5 * static_cast<double>(i % 3);
        const double z = i < 3 ? -0.9 : 0.6;
        file.addSphere(file.addMaterial(all[i]), {x, 0.55, z}, 0.5, 48);
    }
    file.addCamera({0.4, 2.2, 3.6}, {0, 0.4, 0}, 40);
    return file;
}

// Compares the mean over pixels, and the pixels' centres.
void compare(const gltf::Scene& scene, std::uint32_t effects, double mirrorRoughness,
             const std::string& effect, const std::string& what) {
    EffectOptions options;
    options.effects = effects;
    RenderSetup setup = setupOf(scene, kReferenceWidth, kReferenceHeight, kReferenceSamples, {});
    const World world(scene);
    const Reference reference(scene, world);
    const View view(scene.cameras.at(0), kReferenceWidth, kReferenceHeight);
    const auto truths = pixelTruths(
        view, {11, 4}, [](const Ray&) { return true; },
        [&](const Ray& ray, Random&) {
            const Vec3 light = reference.radiance(ray, mirrorRoughness);
            return Estimate{light, Vec3(0.0), light * light};
        });
    expectAgrees(renderEffect(scene, options, setup), truths,
                 {effect, what, "reference renderer", 3, setup.samples, 0.0, 2e-4});

    setup.samples = 1;
    const auto centres =
        centreTruths(view, [&](const Ray& ray) { return reference.radiance(ray, mirrorRoughness); });
    EXPECT_GT(centres.size(), std::size_t{kReferenceWidth} * kReferenceHeight * 9 / 10);
    expectAgrees(renderEffect(scene, options, setup), centres,
                 {effect, "the same, centres of pixels", "reference renderer", 3, 1, 1e-9, kSinglePrecision});
}

TEST(Reference, DirectLightOfASunAndALampOnManyMaterials) {
    SceneFile file = spheresOnFloor(material({0.5, 0.5, 0.5}, 0.0, 0.9));
    file.addLight({{"type", "directional"}, {"intensity", 2.0}}, {2, 3, 2}, {0, 0, 0});
    file.addLight({{"type", "point"}, {"intensity", 6.0}, {"color", {1.0, 0.8, 0.6}}}, {-1.5, 2.0, 1.5},
                  {0, 0, 0});
    const gltf::Scene scene = file.import();
    compare(scene, package::kEffectShadow, -1.0, "direct light", "six materials under a sun and a lamp");
}

// The mirror is white metal: its Fresnel is 1 at any angle, and the fitted albedo by which the device weighs
// mirrors is exact there.
TEST(Reference, AMirrorShowsTheDirectLightOfWhatItSees) {
    SceneFile file = spheresOnFloor(material({1.0, 1.0, 1.0}, 1.0, 0.0));
    file.addLight({{"type", "directional"}, {"intensity", 2.0}}, {2, 3, 2}, {0, 0, 0});
    const gltf::Scene scene = file.import();
    compare(scene, package::kEffectShadow | package::kEffectReflection, 0.0, "reflection",
            "a mirror below six materials");
}

}  // namespace

// A volume within another one: the interface between the two reflects by both indices and by
// KHR_materials_specular.
#include "oracle/device.h"
#include "oracle/refraction.h"
#include "oracle/transport/path_scene.h"
#include "support/effect_bits.h"

namespace {

using namespace glint;
using namespace glint::oracle;
using namespace glint::testing;

constexpr double kOuterIor = 1.5;
constexpr double kInnerIor = 1.7;
constexpr double kSpecular = 0.5;
const Vec3 kSpecularColor(1.0, 64.0, 512.0);  // f0 of blue light is above 1 and is limited

// A slab within a slab, between the camera and a light. To the right there are the same, which a tilted
// mirror shows on the left of the picture.
gltf::Scene slabs() {
    SceneFile file;
    Json outer = glassMaterial({kOuterIor, 1.0, 0.0, Vec3(1.0), 0.0});
    Json inner = glassMaterial({kInnerIor, 1.0, 0.0, Vec3(1.0), 0.0});
    inner["extensions"]["KHR_materials_specular"] = {
        {"specularFactor", kSpecular},
        {"specularColorFactor", {kSpecularColor.x, kSpecularColor.y, kSpecularColor.z}}};
    const auto addSlabs = [&](const Json& material, double near, double far) {
        const std::vector<int> sides(6, file.addMaterial(material));
        file.addBox(sides, {-0.4, -0.4, -far}, {0.4, 0.4, -near}, false);
        file.addBox(sides, {near, -0.4, -0.9}, {far, 0.4, -0.1}, false);
    };
    addSlabs(outer, 1.0, 2.0);
    addSlabs(inner, 1.25, 1.75);
    const int light = file.addMaterial(unlitMaterial());
    file.addQuad(light, {-0.5, -0.5, -3}, {1, 0, 0}, {0, 1, 0});
    file.addQuad(light, {3, -0.5, -1}, {0, 0, 1}, {0, 1, 0});
    const int mirror = file.addMaterial({{"pbrMetallicRoughness", {{"roughnessFactor", 0.0}}}});
    file.addQuad(mirror, {-0.3, -0.3, -0.2}, {0.3, 0, -0.3}, {0, 0.6, 0});
    file.addCamera({0, 0, 0}, {0, 0, -1}, 1.0);
    file.addDarkness();
    return file.import();
}

// What passes, and what is reflected, at normal incidence. Each is the same from both sides.
struct Layer {
    Vec3 reflected;
    Vec3 passed;
};

Layer interfaceOf(double outside, double inside, const Vec3& color, double factor) {
    const double plain = reflectance(Fresnel::Schlick, outside, inside, 1.0);
    const Vec3 f0 = glm::min(plain * color, Vec3(1.0)) * factor;
    return {f0, Vec3(1.0 - std::max({f0.x, f0.y, f0.z}))};
}

// Sums the reflections between two layers.
Layer over(const Layer& first, const Layer& second) {
    const Vec3 between = Vec3(1.0) - first.reflected * second.reflected;
    return {first.reflected + first.passed * first.passed * second.reflected / between,
            first.passed * second.passed / between};
}

Vec3 lightThroughSlabs() {
    const Layer outer = interfaceOf(1.0, kOuterIor, Vec3(1.0), 1.0);
    const Layer inner = interfaceOf(kOuterIor, kInnerIor, kSpecularColor, kSpecular);
    return over(over(outer, over(inner, inner)), outer).passed;
}

TEST(NestedVolumes, ThePathTracerHasTheClosedForm) {
    expectLight(slabs(), GradientSky{}, {}, rayTo({0.003, 0, 0}, {0.003, 0, -1}), lightThroughSlabs(), 0.01,
                20000);
}

// On the right a refracted ray of the primary surface walks through the slabs, on the left a path does.
TEST(NestedVolumes, RefractedRaysAndPathsHaveTheClosedForm) {
    constexpr std::uint32_t kSize = 16;
    constexpr std::uint32_t kBounces = 32;
    compiler::CompileSettings settings;
    settings.maxBounces = kBounces;
    settings.emissiveLights = compiler::EmissiveLights::Off;
    settings.skyLight = compiler::SkyLight::Off;
    settings.effects = {false, package::kEffectReflection | package::kEffectRefraction, 1.0F};
    settings.plan.merge = compiler::MergePolicy::None;
    const gltf::Scene scene = slabs();
    const LoadedScene loaded(scene, settings);
    RenderSetup setup = setupOf(scene, kSize, kSize, 64, {});
    setup.frame.maxInterfaces = 64;
    RendererOptions options;
    options.strategy = package::kStrategyVisibility;
    options.bounces = kBounces;
    const LinearImage image = loaded.render(options, setup);
    const Vec3 truth = lightThroughSlabs();
    for (const bool mirrored : {true, false}) {
        Vec3 mean(0.0);
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            if ((i % kSize < kSize / 2) == mirrored) {
                mean += Vec3(image.pixels[i][0], image.pixels[i][1], image.pixels[i][2]);
            }
        }
        mean *= 2.0 / (kSize * kSize);
        for (int channel = 0; channel < 3; ++channel) {
            EXPECT_NEAR(mean[channel], truth[channel], 0.03 * truth[channel])
                << (mirrored ? "of paths, channel " : "of refracted rays, channel ") << channel;
        }
    }
}

}  // namespace

// Tests hard shadows of lights without a size.
#include "oracle/comparison.h"
#include "oracle/device.h"
#include "oracle/light.h"
#include "oracle/scene_file.h"
#include "support/effect_bits.h"

namespace {

using namespace glint;
using namespace glint::oracle;
using namespace glint::testing;

constexpr std::uint32_t kHardShadowSamples = 256;

// Returns direct light of the scene's only light on diffuse surfaces with albedo 1.
Estimate lightOf(const World& world, const gltf::Light& light, const Ray& ray) {
    const Hit hit = *world.closest(ray, Faces::Culled);
    const LightCap cap = lightCap(light, {}, hit.position);
    const double cosine = std::max(glm::dot(hit.normal, cap.direction), 0.0);
    const bool seen = world.visible({hit.position, cap.direction}, cap.centerDistance);
    const Vec3 radiance = seen ? irradianceFrom(light, hit.position) * (cosine / kPi) : Vec3(0.0);
    return {radiance, Vec3(0.0), radiance * radiance};
}

// A block on a floor.
SceneFile blockOnFloor() {
    SceneFile file;
    const int white = file.addMaterial(diffuseMaterial());
    file.addQuad(white, {-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
    file.addBox(std::vector<int>(6, white), {-0.5, 0, -0.5}, {0.5, 1, 0.5}, false);
    file.addCamera({0.5, 4, 4}, {0, 0.2, 0}, 40);
    return file;
}

void compare(const gltf::Scene& scene, const std::string& what) {
    EffectOptions options;
    options.effects = package::kEffectShadow;
    const LinearImage image = renderEffect(scene, options, setupOf(scene, 48, 27, kHardShadowSamples, {}));
    const World world(scene);
    const View view(scene.cameras[0], 48, 27);
    const auto truths = pixelTruths(
        view, {22, 4}, [&](const Ray& ray) { return world.closest(ray, Faces::Culled).has_value(); },
        [&](const Ray& ray, Random&) { return lightOf(world, scene.lights[0], ray); });
    EXPECT_GT(truths.size(), 1000U);
    // The rasteriser sees an edge within 1/256 of a pixel, and the golden points of the pixel are not
    // independent.
    expectAgrees(image, truths, {"shadow", what, "quadrature", 1, samplesOf(kHardShadowSamples), 0.0, 1e-4});
}

TEST(HardShadow, OfASun) {
    SceneFile file = blockOnFloor();
    file.addLight({{"type", "directional"}, {"intensity", 3.0}}, {2, 3, 1}, {0, 0, 0});
    compare(file.import(), "a block under the sun");
}

TEST(HardShadow, OfALampAndASpot) {
    for (const bool spot : {false, true}) {
        SceneFile file = blockOnFloor();
        Json light{{"type", spot ? "spot" : "point"}, {"intensity", 20.0}, {"range", 8.0}};
        if (spot) {
            light["spot"] = {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.6}};
        }
        file.addLight(light, {1.5, 2.5, 0.5}, {0, 0, 0});
        compare(file.import(), spot ? "a block under a spot" : "a block under a lamp");
    }
}

}  // namespace

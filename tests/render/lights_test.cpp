// Tests light, shadow and alpha at single pixels, computed by hand. Each test holds for both strategies.
#include "render/pixel_test.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

// The formulas below are for light that microfacets reflect once.
class Lights : public PixelTest {
protected:
    void SetUp() override {
        energyCompensation_ = false;
    }
};

INSTANTIATE_TEST_SUITE_P(Strategies, Lights,
                         ::testing::Values(package::kStrategyUber, package::kStrategyVisibility),
                         strategyName);

// Tests a diffuse surface. f0 = 0 by a metallic factor of 1 and black, plus emission, would hide the light,
// so this uses the dielectric BRDF at normal incidence: (1 - F) albedo / π + F D V with F = 0.04.
TEST_P(Lights, DirectLightOnADiffuseWallIsAnalytic) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material material;
    material["metallicFactor"] = 0.0F;
    material["baseColorFactor"] = {0.5F, 0.5F, 0.5F, 1.0F};
    addQuad(scene, material, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    addDirectionalLight(scene, {0, 0, -1}, 2.0F);
    const RenderSetup setup = darkSetup(scene, 33);  // a pixel in the middle, whose ray is the axis
    const LinearImage image = render(scene, setup);
    // For alpha = 1, D = 1/π and V = 1/4 at normal incidence.
    const float pi = std::numbers::pi_v<float>;
    const float expected = 2.0F * (0.96F * 0.5F / pi + 0.04F / pi * 0.25F);
    expectColor(at(image, 16, 16), {expected, expected, expected}, 1e-5F, "centre");
}

// Returns what a diffuse wall at z = -1 sends along the axis under a light of `irradiance` lux at normal
// incidence.
float wallRadiance(float irradiance) {
    const float pi = std::numbers::pi_v<float>;
    return irradiance * (0.96F * 0.5F / pi + 0.04F / pi * 0.25F);
}

float litWall(const gltf::Light& light,
              const std::function<LinearImage(const gltf::Scene&, const RenderSetup&)>& render) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material material;
    material["metallicFactor"] = 0.0F;
    material["baseColorFactor"] = {0.5F, 0.5F, 0.5F, 1.0F};
    addQuad(scene, material, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    scene.lights.push_back(light);
    const RenderSetup setup = darkSetup(scene, 33);
    const LinearImage image = render(scene, setup);
    return image.pixels.empty() ? -1.0F : at(image, 16, 16)[0];
}

TEST_P(Lights, PunctualLightsFollowTheirExtension) {
    const auto toImage = [&](const gltf::Scene& scene, const RenderSetup& setup) {
        return render(scene, setup);
    };
    gltf::Light point;
    point.type = gltf::LightType::Point;
    point.intensity = 8.0F;
    point.position = {0.0F, 0.0F, 1.0F};  // 2 m from the wall
    EXPECT_NEAR(litWall(point, toImage), wallRadiance(8.0F / 4.0F), 1e-5F) << "inverse square";
    point.range = 4.0F;
    EXPECT_NEAR(litWall(point, toImage), wallRadiance(8.0F / 4.0F * (1.0F - 1.0F / 16.0F)), 1e-5F)
        << "window";
    point.range = 2.0F;
    EXPECT_NEAR(litWall(point, toImage), 0.0F, 1e-6F) << "at its range";

    gltf::Light spot = point;
    spot.range = 0.0F;
    spot.type = gltf::LightType::Spot;
    spot.direction = {0.0F, 0.0F, -1.0F};
    spot.innerConeAngle = 0.2F;
    spot.outerConeAngle = 0.6F;
    EXPECT_NEAR(litWall(spot, toImage), wallRadiance(2.0F), 1e-5F) << "inside the inner cone";
    spot.direction = {0.0F, std::sin(0.4F), -std::cos(0.4F)};
    const float cone = (std::cos(0.4F) - std::cos(0.6F)) / (std::cos(0.2F) - std::cos(0.6F));
    EXPECT_NEAR(litWall(spot, toImage), wallRadiance(2.0F * cone * cone), 1e-4F) << "between the cones";
    spot.direction = {0.0F, std::sin(0.7F), -std::cos(0.7F)};
    EXPECT_NEAR(litWall(spot, toImage), 0.0F, 1e-6F) << "outside";
}

// Extreme lights stay finite, and are dark if they have no direction or do not reach the surface.
TEST_P(Lights, LightsAtTheirLimitsStayFinite) {
    const auto toImage = [&](const gltf::Scene& scene, const RenderSetup& setup) {
        Renderer::Counters counters;
        LinearImage image = render(scene, setup, package::AlphaPolicy::Opaque, &counters);
        EXPECT_EQ(counters.nonFinite, 0U);
        for (const Pixel& pixel : image.pixels) {
            EXPECT_TRUE(std::isfinite(pixel[0] + pixel[1] + pixel[2]));
        }
        return image;
    };
    gltf::Light point;
    point.type = gltf::LightType::Point;
    point.intensity = 8.0F;
    point.position = {0.0F, 0.0F, -1.0F};
    EXPECT_EQ(litWall(point, toImage), 0.0F) << "at the shaded point, on no side of it";
    point.position = {0.0F, 0.0F, -0.9995F};
    EXPECT_NEAR(litWall(point, toImage) / wallRadiance(3.2e7F), 1.0F, 1e-3F) << "nearer than a millimetre";
    point.position = {0.0F, 0.0F, 1.0F};
    for (const float range : {1e-38F, 1e-6F}) {
        point.range = range;
        EXPECT_EQ(litWall(point, toImage), 0.0F) << "range " << range;
    }
    point.range = 1e30F;
    EXPECT_NEAR(litWall(point, toImage), wallRadiance(2.0F), 1e-5F) << "endless range";
    point.range = 0.0F;
    point.position = {0.0F, 0.0F, 1e20F};
    EXPECT_NEAR(litWall(point, toImage), 0.0F, 1e-30F) << "farther than a square can tell";

    gltf::Light spot = point;
    spot.type = gltf::LightType::Spot;
    spot.position = {0.0F, 0.0F, 1.0F};
    spot.direction = {0.0F, 0.0F, -1.0F};
    spot.innerConeAngle = spot.outerConeAngle = 0.3F;
    EXPECT_NEAR(litWall(spot, toImage), wallRadiance(2.0F), 1e-5F) << "inside equal cones";
    spot.direction = {0.0F, std::sin(0.31F), -std::cos(0.31F)};
    EXPECT_EQ(litWall(spot, toImage), 0.0F) << "outside equal cones";
    spot.direction = {0.0F, 0.0F, 0.0F};
    EXPECT_EQ(litWall(spot, toImage), 0.0F) << "spot without a direction";
    spot.innerConeAngle = 0.0F;
    spot.outerConeAngle = std::numbers::pi_v<float> / 2.0F;
    EXPECT_NEAR(litWall(spot, toImage), 0.0F, 1e-6F) << "wide spot without a direction";

    gltf::Light sun;
    sun.intensity = 3.0F;
    sun.direction = {0.0F, 0.0F, 0.0F};
    EXPECT_EQ(litWall(sun, toImage), 0.0F) << "sun without a direction";
}

// A hit takes one random light. Over many samples it shows the sum of all, which a primary surface shows at
// once.
TEST_P(Lights, TheChosenLightOfAHitIsUnbiased) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material white;
    white["metallicFactor"] = 0.0F;
    const int wall = addMaterial(scene, white);
    // The left half of the view shows the wall behind the camera in a mirror. The right half shows the same
    // wall in front, mirrored about the mirror's plane, so that both see it from the same distance and angle.
    addQuad(scene, mirrorMaterial(), {-1, -1, -1}, {1, 0, 0}, {0, 2, 0});
    addQuad(scene, wall, {9, -9, 3}, {-18, 0, 0}, {0, 18, 0});
    addQuad(scene, wall, {0.001F, -9, -5}, {9, 0, 0}, {0, 18, 0});
    // Two lights are in front of each wall, mirrored in the same way. Their range ends in front of the other
    // wall.
    gltf::Light light;
    light.type = gltf::LightType::Point;
    light.range = 5.0F;
    for (const float side : {-1.0F, 1.0F}) {
        light.intensity = 8.0F;
        light.position = {2.0F * side, 1.0F, -1.0F - 2.5F * side};
        scene.lights.push_back(light);
        light.intensity = 12.0F;
        light.position = {3.0F * side, -1.5F, -1.0F - 3.0F * side};
        scene.lights.push_back(light);
    }
    RenderSetup setup = darkSetup(scene);
    setup.samples = 128;
    const LinearImage image = render(scene, setup);
    std::vector<double> ratios;
    for (std::uint32_t y = 8; y < 24; ++y) {
        for (std::uint32_t x = 4; x < 12; ++x) {
            ratios.push_back(at(image, x, y)[0] / at(image, 31 - x, y)[0]);
        }
    }
    // Jitter moves both halves the same way, so pixels on a slope differ by up to 2 %. The lights' own images
    // in the mirror outshine a few.
    std::ranges::sort(ratios);
    EXPECT_NEAR(ratios[ratios.size() / 2], 1.0, 0.005);
    EXPECT_NEAR(ratios[ratios.size() / 20], 1.0, 0.02);
    EXPECT_NEAR(ratios[ratios.size() * 19 / 20], 1.0, 0.02);
}

// A wall is lit by the sun with a plate in between. The plate's shadow lies on the wall, in the picture and
// in a mirror.
gltf::Scene shadowScene(bool shadeInMirror, int plateMaterialKind) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material white;
    white["metallicFactor"] = 0.0F;
    const int wall = addMaterial(scene, white);
    materials::Material plate = unlitMaterial(kRed);
    plate.doubleSided = true;
    if (plateMaterialKind == 1) {
        plate.alphaMode = materials::AlphaMode::Mask;
        plate["baseColorFactor"][3] = 0.0F;  // cut out entirely
    }
    const int plateMaterial = addMaterial(scene, plate);
    if (!shadeInMirror) {
        addQuad(scene, wall, {-4, -4, -2}, {8, 0, 0}, {0, 8, 0});
        // The plate is above the frustum's centre line, between the sun and the wall's middle.
        addQuad(scene, plateMaterial, {-1, 3, -1.0F}, {2, 0, 0}, {0, 0, -0.5F});
        addDirectionalLight(scene, {0.0F, -0.9284767F, -0.3713907F}, 3.0F);
    } else {
        const int mirror = addMaterial(scene, mirrorMaterial());
        addQuad(scene, mirror, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
        addQuad(scene, wall, {9, -9, 3}, {-18, 0, 0}, {0, 18, 0});
        addQuad(scene, plateMaterial, {-1, 3, 1.5F}, {2, 0, 0}, {0, 0, 0.7F});
        addDirectionalLight(scene, {0.0F, -0.9284767F, 0.3713907F}, 3.0F);
    }
    return scene;
}

TEST_P(Lights, AShadowFallsOnAWall) {
    const gltf::Scene scene = shadowScene(false, 0);
    const RenderSetup setup = darkSetup(scene);
    const LinearImage image = render(scene, setup);
    // The plate is at y = 3, z in [-1.5, -1]. The sun falls by 2.5 for each 1 in -z, so the shadow is on z =
    // -2 at y in [0.5, 1.75].
    expectColor(at(image, 16, 7), {0, 0, 0}, 1e-6F, "in the shadow, y = 1.06");
    EXPECT_GT(at(image, 16, 24)[1], 0.1F) << "below the shadow";
    EXPECT_GT(at(image, 2, 7)[1], 0.1F) << "beside the shadow";
}

TEST_P(Lights, AReflectedSurfaceHasItsShadow) {
    const gltf::Scene scene = shadowScene(true, 0);
    const RenderSetup setup = darkSetup(scene);
    const LinearImage image = render(scene, setup);
    // The shadow is on z = 3 at y in [3 - 2.5 * 1.5, 3 - 2.5 * 0.8] = [-0.75, 1]. The ray of row r meets z =
    // 3 after 5 units of depth in all: y = 5 p.
    expectColor(at(image, 16, 16), {0, 0, 0}, 1e-6F, "in the shadow, y = -0.16");
    EXPECT_GT(at(image, 16, 0)[1], 0.1F) << "above the shadow, past the plate";
    EXPECT_GT(at(image, 28, 16)[1], 0.1F) << "beside the shadow";
}

TEST_P(Lights, AlphaIsTestedOrForcedOpaqueAsThePackageSays) {
    const gltf::Scene scene = shadowScene(true, 1);
    const RenderSetup setup = darkSetup(scene);
    const LinearImage opaque = render(scene, setup, package::AlphaPolicy::Opaque);
    const LinearImage tested = render(scene, setup, package::AlphaPolicy::Tested);
    ASSERT_FALSE(opaque.pixels.empty() || tested.pixels.empty());
    expectColor(at(opaque, 16, 16), {0, 0, 0}, 1e-6F, "opaque: the cut-out plate throws a shadow");
    EXPECT_GT(at(tested, 16, 16)[1], 0.1F) << "tested: it does not";
}

}  // namespace

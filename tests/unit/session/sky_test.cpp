// How bright the default sky becomes, against what light formulas give by hand.
#include <glint/session/sky.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace glint::session {
namespace {

constexpr gltf::Matrix4 kUnmoved{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
constexpr session::SurfacePoint kFloor{{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};

LightView light(LightView::Type type, float intensity) {
    LightView light;
    light.type = type;
    light.intensity = {intensity, intensity, intensity};
    light.direction = {0.0F, -1.0F, 0.0F};
    return light;
}

LightView lampAbove(float candela, float height) {
    LightView lamp = light(LightView::Type::Point, candela);
    lamp.position = {0.0F, height, 0.0F};
    return lamp;
}

TEST(SkyChoice, DirectionalLightsAreInLux) {
    LightView sun = light(LightView::Type::Directional, 1000.0F);
    EXPECT_NEAR(illuminanceAt(sun, kFloor), 1000.0, 1e-3);
    const auto cosine = static_cast<float>(std::sqrt(0.5));
    sun.direction = {cosine, -cosine, 0.0F};
    EXPECT_NEAR(illuminanceAt(sun, kFloor), 1000.0 * std::sqrt(0.5), 1e-3);
    sun.direction = {0.0F, 1.0F, 0.0F};
    EXPECT_EQ(illuminanceAt(sun, kFloor), 0.0) << "from behind";
    sun = light(LightView::Type::Directional, 0.0F);
    sun.intensity = {0.0F, 100.0F, 0.0F};
    EXPECT_NEAR(illuminanceAt(sun, kFloor), 71.52, 1e-3) << "the luminance of green";
}

TEST(SkyChoice, PointLightsAreInCandela) {
    EXPECT_NEAR(illuminanceAt(lampAbove(800.0F, 2.0F), kFloor), 200.0, 1e-3);
    // Off to the side: the distance is the root of 2, and the cosine half of that.
    LightView aside = lampAbove(800.0F, 1.0F);
    aside.position[0] = 1.0F;
    EXPECT_NEAR(illuminanceAt(aside, kFloor), 800.0 / 2.0 * std::sqrt(0.5), 1e-3);
    LightView ranged = lampAbove(800.0F, 2.0F);
    ranged.range = 4.0F;
    EXPECT_NEAR(illuminanceAt(ranged, kFloor), 200.0 * (1.0 - 1.0 / 16.0), 1e-3);
    ranged.range = 1.0F;
    EXPECT_EQ(illuminanceAt(ranged, kFloor), 0.0);
    EXPECT_EQ(illuminanceAt(lampAbove(800.0F, 0.0F), kFloor), 0.0) << "a light in the surface itself";
    EXPECT_NEAR(illuminanceAt(lampAbove(1.0F, 1e-4F), kFloor), 1e8, 100.0) << "scenes may be small";
    EXPECT_NEAR(illuminanceAt(lampAbove(1.0F, 1e-12F), kFloor), 1e20, 1e14) << "no nearer than 1e-10 m";
}

TEST(SkyChoice, SpotsEndAtTheirCone) {
    LightView spot = light(LightView::Type::Spot, 100.0F);
    spot.position = {0.0F, 2.0F, 0.0F};
    spot.innerConeAngle = 0.2F;
    spot.outerConeAngle = 0.6F;
    EXPECT_NEAR(illuminanceAt(spot, kFloor), 25.0, 1e-4);
    spot.direction = {std::sin(0.4F), -std::cos(0.4F), 0.0F};
    const double cone = (std::cos(0.4) - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6));
    EXPECT_NEAR(illuminanceAt(spot, kFloor), 25.0 * cone * cone, 1e-4);
    spot.direction = {std::sin(0.7F), -std::cos(0.7F), 0.0F};
    EXPECT_EQ(illuminanceAt(spot, kFloor), 0.0);
}

gltf::Primitive square() {
    gltf::Primitive primitive;
    primitive.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    primitive.indices = {0, 1, 2, 0, 2, 3};
    return primitive;
}

// The square, which faces up, at a scale along X and Z.
gltf::Node placed(double x, double z) {
    gltf::Node node;
    node.mesh = 0;
    node.world = kUnmoved;
    node.world[0] = x;
    node.world[10] = z;
    return node;
}

std::vector<session::LitPatch> patchesOf(const gltf::Scene& scene, const std::vector<LightView>& lights) {
    return litPatches(scene, makeSceneView(scene), lights);
}

gltf::Scene floorOf(double x, double z) {
    gltf::Scene scene;
    scene.meshes.resize(1);
    scene.meshes[0].primitives = {square()};
    scene.nodes = {placed(x, z)};
    return scene;
}

double areaOf(const std::vector<session::LitPatch>& patches) {
    double area = 0.0;
    for (const session::LitPatch& patch : patches) {
        area += patch.area;
    }
    return area;
}

TEST(SkyChoice, PatchesHaveTheArea) {
    EXPECT_NEAR(areaOf(patchesOf(floorOf(2.0, 3.0), {})), 24.0, 1e-9);
    EXPECT_NEAR(areaOf(patchesOf(floorOf(2.0, 3.0), {lampAbove(1.0F, 0.1F)})), 24.0, 1e-9) << "divided";
    // 20,000 triangles too small for a patch each, beside a large one.
    gltf::Scene scene = floorOf(100.0, 100.0);
    scene.nodes.resize(10001, placed(0.01, 0.01));
    const std::vector<session::LitPatch> patches = patchesOf(scene, {});
    EXPECT_LT(patches.size(), 100U);
    EXPECT_NEAR(areaOf(patches) / (40000.0 + 4.0), 1.0, 1e-3);
    EXPECT_TRUE(patchesOf(gltf::Scene{}, {}).empty());
}

// A transform that mirrors does not turn the front away.
TEST(SkyChoice, PatchesFaceTheFront) {
    const std::vector<LightView> sun{light(LightView::Type::Directional, 10.0F)};
    for (const double x : {1.0, -1.0}) {
        for (const session::LitPatch& patch : patchesOf(floorOf(x, 1.0), sun)) {
            EXPECT_NEAR(patch.illuminance, 10.0, 1e-5) << x;
        }
    }
}

// On a plane without end half of what a lamp sends down falls within 60 degrees.
TEST(SkyChoice, PatchesReceiveTheFluxOfALamp) {
    const std::vector<session::LitPatch> patches = patchesOf(floorOf(1e4, 1e4), {lampAbove(100.0F, 2.0F)});
    double flux = 0.0;
    double bright = 0.0;
    for (const session::LitPatch& patch : patches) {
        flux += patch.illuminance * patch.area;
        bright += patch.illuminance >= 100.0 / 4.0 / 8.0 ? patch.illuminance * patch.area : 0.0;
    }
    EXPECT_NEAR(flux / (2.0 * std::numbers::pi * 100.0), 1.0, 0.02);
    EXPECT_NEAR(bright / flux, 0.5, 0.03);
    EXPECT_LT(patches.size(), 20000U);
}

TEST(SkyChoice, TypicalIsWhereMostLightArrives) {
    // By area, the geometric mean of 100 and 4 lux.
    EXPECT_NEAR(*typicalIlluminance({{100.0, 1.0}, {4.0, 25.0}}),
                std::exp((std::log(100.0) + 25.0 * std::log(4.0)) / 26.0), 1e-9);
    // A large dark ground, a small bright shade, and what no light reaches change little.
    EXPECT_NEAR(*typicalIlluminance({{50.0, 10.0}, {1e-6, 1e6}, {0.0, 1e9}}), 50.0, 1e-9);
    EXPECT_NEAR(*typicalIlluminance({{50.0, 10.0}, {1e4, 0.05}}) / 50.0, 1.0, 0.03);
    EXPECT_FALSE(typicalIlluminance({{0.0, 1.0}}).has_value());
    EXPECT_FALSE(typicalIlluminance({}).has_value());
}

// A lamp lights no more of a ground than lies around it, however far that reaches.
TEST(SkyChoice, TheSizeOfTheGroundHardlyCounts) {
    const std::vector<LightView> lamp{lampAbove(4000.0F, 3.0F)};
    const double near = *typicalIlluminance(patchesOf(floorOf(20.0, 20.0), lamp));
    const double far = *typicalIlluminance(patchesOf(floorOf(2e4, 2e4), lamp));
    EXPECT_GT(far / near, 1.0 / 3.0) << "a million times the area";
    EXPECT_LT(far / near, 1.0);
    EXPECT_GT(near, 4000.0 / 9.0 * 0.01);
    EXPECT_LT(near, 4000.0 / 9.0);
}

TEST(SkyChoice, TheSkyBringsAsMuchAsTheLights) {
    EXPECT_NEAR(meanIlluminance({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}), std::numbers::pi, 1e-6);
    for (const double lux : {0.005, 1.0, 1000.0, 1e6}) {
        const session::SkyChoice choice = skyForLights({{lux, 1.0}});
        EXPECT_NEAR(meanIlluminance(choice.sky()) / lux, 1.0, 1e-5) << lux;
        EXPECT_TRUE(choice.automatic);
    }
}

TEST(SkyChoice, WithoutLightTheSkyStays) {
    EXPECT_EQ(skyForLights({}).scale, 1.0);
    const session::SkyChoice black = skyForLights(patchesOf(floorOf(1.0, 1.0), {lampAbove(0.0F, 2.0F)}));
    EXPECT_EQ(black.scale, 1.0);
    EXPECT_FALSE(black.lights.has_value());
}

TEST(SkyChoice, ExtremeLightsGiveAFiniteSky) {
    for (const float candela : {std::numeric_limits<float>::max(), 1e-38F}) {
        const SkyView sky = skyForLights(patchesOf(floorOf(1.0, 1.0), {lampAbove(candela, 1e-4F)})).sky();
        for (const float channel : {sky.zenith[0], sky.horizon[2], sky.ground[1]}) {
            EXPECT_TRUE(std::isfinite(channel) && channel > 0.0F) << candela;
        }
    }
}

}  // namespace
}  // namespace glint::session

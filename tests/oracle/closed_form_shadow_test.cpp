// Compares the light of lights that have a size, by quadrature, with closed forms.
#include "oracle/expect.h"
#include "oracle/light.h"
#include "oracle/scene_file.h"

namespace {

using namespace glint;
using namespace glint::oracle;

constexpr Vec3 kClosedFormShadowUp(0.0, 1.0, 0.0);
constexpr double kSun = 0.2;  // half angle
constexpr Circle kSunAtZenith{kClosedFormShadowUp, kSun};
constexpr int kStrata = 96;

gltf::Light sun(const Vec3& towards) {
    gltf::Light light;
    const Vec3 direction = -glm::normalize(towards);
    light.direction = {static_cast<float>(direction.x), static_cast<float>(direction.y),
                       static_cast<float>(direction.z)};
    return light;
}

Estimate irradianceOfSun(const World& world, const Vec3& position, Random& random) {
    const LightCap cap = lightCap(sun(kClosedFormShadowUp), {0.0, 2.0 * kSun}, position);
    return irradianceOfCap(world, cap, position, kClosedFormShadowUp, {kStrata, 4}, random);
}

// A half plane at height 1 covers x < 0. Seen from (x, 0, 0), its edge is atan(x) beside the zenith.
TEST(OracleShadow, OfAStraightEdgeBeforeTheSun) {
    SceneFile file;
    file.addQuad(file.addMaterial(diffuseMaterial()), {-100, 1, -100}, {0, 0, 200}, {100, 0, 0});
    const World world(file.import());
    Random random(1);
    for (const double x : {-0.3, -0.15, -0.05, 0.0, 0.02, 0.1, 0.19, 0.3}) {
        const Estimate estimate = irradianceOfSun(world, {x, 0, 0}, random);
        const Circle hidden{glm::normalize(Vec3(-1.0, -x, 0.0)), 0.5 * kPi};
        expectEstimate(estimate, irradianceBesides(kSunAtZenith, hidden, kClosedFormShadowUp), 1e-3);
    }
}

// The segment that a plane cuts off, in the limit of a small sun: (acos h - h sqrt(1 - h²)) / π.
TEST(OracleShadow, TheSegmentOfASmallSunIsThatOfADisk) {
    constexpr double kSmall = 1e-3;
    for (const double h : {-0.9, -0.3, 0.0, 0.4, 0.8}) {
        const double planar = (std::acos(h) - h * std::sqrt(1.0 - h * h)) / kPi;
        const Circle hidden{Vec3(-std::cos(h * kSmall), std::sin(h * kSmall), 0.0), 0.5 * kPi};
        const Circle light{kClosedFormShadowUp, kSmall};
        EXPECT_NEAR(irradianceBesides(light, hidden, kClosedFormShadowUp), planar, 1e-6);
    }
}

TEST(OracleShadow, OfASphereBeforeTheSun) {
    World world;
    const Vec3 center(0, 3, 0);
    world.addSphere(center, 0.4);
    Random random(2);
    for (const double x : {0.0, 0.15, 0.3, 0.6, 0.9, 1.2}) {
        const Vec3 position(x, 0, 0);
        const double distance = glm::length(center - position);
        const Estimate estimate = irradianceOfSun(world, position, random);
        // On the axis the edge of the shadow runs along the strata, so the repeats need not differ even by
        // one point.
        const Circle hidden{(center - position) / distance, std::asin(0.4 / distance)};
        expectEstimate(estimate, irradianceBesides(kSunAtZenith, hidden, kClosedFormShadowUp), 1e-3,
                       1.0 / (4.0 * kStrata * kStrata));
    }
}

// Under the middle of a disk that is smaller than the sun, the light is the ratio of two caps.
TEST(OracleShadow, OfADiskBeforeTheSun) {
    SceneFile file;
    constexpr int kCorners = 256;
    file.addDisk(file.addMaterial(diffuseMaterial()), {0, 2, 0}, {0, 1, 0}, 0.25, kCorners);
    const World world(file.import());
    Random random(3);
    const double hidden = squared(std::sin(std::atan(0.125)) / std::sin(kSun));
    // The disk's polygon has its area, but not its outline. The cap differs by less than the square of the
    // sun.
    expectEstimate(irradianceOfSun(world, {0, 0, 0}, random), 1.0 - hidden, 1e-3, 1e-4);
    const Circle disk{kClosedFormShadowUp, std::atan(0.125)};
    EXPECT_NEAR(irradianceBesides(kSunAtZenith, disk, kClosedFormShadowUp), 1.0 - hidden, 1e-12);
}

// The same from beside the disk's axis. The light is known in simple cases: a disk that is completely
// within the sun, and the limit of a small sun, where the caps are disks in a plane.
TEST(OracleShadow, OfADiskAsideOfTheSun) {
    SceneFile file;
    file.addDisk(file.addMaterial(diffuseMaterial()), {0, 2, 0}, {0, 1, 0}, 0.25, 256);
    const World world(file.import());
    Random random(6);
    for (const double x : {0.02, 0.1, 0.2, 0.4, 0.6, 0.7}) {
        const double light = irradianceBesidesDisk(kSun, 0.125, 0.5 * x);
        expectEstimate(irradianceOfSun(world, {x, 0, 0}, random), light, 1e-3, 1e-4);
    }
    EXPECT_NEAR(irradianceBesidesDisk(kSun, 0.125, 1e-9),
                1.0 - squared(std::sin(std::atan(0.125)) / std::sin(kSun)), 1e-6);
    EXPECT_EQ(irradianceBesidesDisk(kSun, 0.125, 1.0), 1.0);
    EXPECT_NEAR(irradianceBesidesDisk(kSun, 1.0, 0.5), 0.0, 1e-6);
    // For two circles of radius r whose centres are r apart, the lens is 2/3 - sqrt(3) / (2 π) of either.
    EXPECT_NEAR(irradianceBesidesDisk(1e-4, std::tan(1e-4), std::tan(1e-4)),
                1.0 / 3.0 + std::sqrt(3.0) / (2.0 * kPi), 1e-6);
}

// A disk between a point and a lamp with a radius: they are two caps about one axis. A disk behind the lamp
// hides nothing.
TEST(OracleShadow, OfADiskBeforeALamp) {
    SceneFile file;
    const int material = file.addMaterial(diffuseMaterial());
    file.addDisk(material, {0, 1, 0}, {0, 1, 0}, 0.05, 256);
    file.addDisk(material, {0, 3.5, 0}, {0, 1, 0}, 2.0, 256);
    const World world(file.import());
    gltf::Light lamp;
    lamp.type = gltf::LightType::Point;
    lamp.position = {0.0F, 3.0F, 0.0F};
    const LightCap cap = lightCap(lamp, {0.3, 0.0}, Vec3(0.0));
    EXPECT_NEAR(cap.halfAngle, std::asin(0.1), 1e-12);
    Random random(4);
    const double hidden = squared(std::sin(std::atan(0.05)) / 0.1);
    expectEstimate(irradianceOfCap(world, cap, Vec3(0.0), kClosedFormShadowUp, {kStrata, 4}, random),
                   1.0 - hidden, 1e-3, 1e-4);
}

// A surface gets the light of a point, unless it hides part of the light itself.
TEST(OracleShadow, ALampNearTheHorizon) {
    const World world;
    Random random(5);
    for (const double elevation : {-0.16, -0.14, -0.05, 0.0, 0.05, 0.14, 0.16, 1.0}) {
        gltf::Light lamp;
        lamp.type = gltf::LightType::Point;
        lamp.position = {static_cast<float>(2.0 * std::cos(elevation)),
                         static_cast<float>(2.0 * std::sin(elevation)), 0.0F};
        const LightCap cap = lightCap(lamp, {0.3, 0.0}, Vec3(0.0));
        const double closed = irradianceAboveHorizon({cap.direction, cap.halfAngle}, kClosedFormShadowUp);
        expectEstimate(irradianceOfCap(world, cap, Vec3(0.0), kClosedFormShadowUp, {kStrata, 4}, random),
                       closed, 1e-3);
        if (elevation > 0.15) {
            EXPECT_NEAR(closed, std::sin(elevation), 1e-7);
        } else if (elevation == 0.0) {
            const double a = cap.halfAngle;
            EXPECT_NEAR(closed, (a - std::sin(a) * std::cos(a)) / (kPi * squared(std::sin(a))), 1e-7);
        } else if (elevation < -0.15) {
            EXPECT_EQ(closed, 0.0);
        }
    }
}

TEST(OracleShadow, LightsFallOffAsTheirExtensionSays) {
    gltf::Light lamp;
    lamp.type = gltf::LightType::Point;
    lamp.intensity = 8.0F;
    lamp.color = {1.0F, 0.5F, 0.25F};
    lamp.position = {0.0F, 2.0F, 0.0F};
    EXPECT_NEAR(irradianceFrom(lamp, Vec3(0.0)).x, 2.0, 1e-12);
    EXPECT_NEAR(irradianceFrom(lamp, Vec3(0.0)).z, 0.5, 1e-12);
    lamp.range = 4.0F;
    EXPECT_NEAR(irradianceFrom(lamp, Vec3(0.0)).x, 2.0 * (1.0 - 1.0 / 16.0), 1e-12);
    lamp.range = 1.0F;
    EXPECT_EQ(irradianceFrom(lamp, Vec3(0.0)).x, 0.0);
    lamp.range = 0.0F;
    lamp.type = gltf::LightType::Spot;
    lamp.direction = {0.0F, -1.0F, 0.0F};
    lamp.innerConeAngle = 0.2F;
    lamp.outerConeAngle = 0.6F;
    EXPECT_NEAR(irradianceFrom(lamp, Vec3(0.0)).x, 2.0, 1e-12);
    const double cone = (std::cos(0.4) - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6));
    const Vec3 aside(2.0 * std::tan(0.4), 0.0, 0.0);
    EXPECT_NEAR(irradianceFrom(lamp, aside).x, 2.0 * std::pow(std::cos(0.4), 2.0) * cone * cone, 1e-6);
}

}  // namespace

// Compares visible shares of lights by quadrature with closed forms.
#include "oracle/expect.h"
#include "oracle/light.h"
#include "oracle/scene_file.h"

namespace {

using namespace glint;
using namespace glint::oracle;

constexpr Vec3 kClosedFormShadowUp(0.0, 1.0, 0.0);
constexpr double kSun = 0.2;  // half angle
constexpr int kStrata = 96;

gltf::Light sun(const Vec3& towards) {
    gltf::Light light;
    const Vec3 direction = -glm::normalize(towards);
    light.direction = {static_cast<float>(direction.x), static_cast<float>(direction.y),
                       static_cast<float>(direction.z)};
    return light;
}

Estimate shareOfSun(const World& world, const Vec3& position, Random& random) {
    const LightCap cap = lightCap(sun(kClosedFormShadowUp), {0.0, 2.0 * kSun}, position);
    return visibleShare(world, cap, position, kClosedFormShadowUp, {kStrata, 4}, random);
}

// A half plane at height 1 covers x < 0. Seen from (x, 0, 0), its edge is atan(x) beside the zenith.
TEST(OracleShadow, OfAStraightEdgeBeforeTheSun) {
    SceneFile file;
    file.addQuad(file.addMaterial(diffuseMaterial()), {-100, 1, -100}, {0, 0, 200}, {100, 0, 0});
    const World world(file.import());
    Random random(1);
    for (const double x : {-0.3, -0.15, -0.05, 0.0, 0.02, 0.1, 0.19, 0.3}) {
        const Estimate estimate = shareOfSun(world, {x, 0, 0}, random);
        expectEstimate(estimate, shareBesidesEdge(kSun, -std::atan(x)), 1e-3);
    }
}

// The segment that a plane cuts off, in the limit of a small sun: (acos h - h sqrt(1 - h²)) / π.
TEST(OracleShadow, TheSegmentOfASmallSunIsThatOfADisk) {
    constexpr double kSmall = 1e-3;
    for (const double h : {-0.9, -0.3, 0.0, 0.4, 0.8}) {
        const double planar = (std::acos(h) - h * std::sqrt(1.0 - h * h)) / kPi;
        EXPECT_NEAR(shareBesidesEdge(kSmall, h * kSmall), planar, 1e-6);
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
        const double apart = std::atan(x / 3.0);
        const Estimate estimate = shareOfSun(world, position, random);
        // On the axis the edge of the shadow runs along the strata, so the repeats need not differ even by
        // one point.
        expectEstimate(estimate, shareBesidesCap(kSun, std::asin(0.4 / distance), apart), 1e-3,
                       1.0 / (4.0 * kStrata * kStrata));
    }
}

// Under the middle of a disk that is smaller than the sun, the share is the ratio of two caps.
TEST(OracleShadow, OfADiskBeforeTheSun) {
    SceneFile file;
    constexpr int kCorners = 256;
    file.addDisk(file.addMaterial(diffuseMaterial()), {0, 2, 0}, {0, 1, 0}, 0.25, kCorners);
    const World world(file.import());
    Random random(3);
    const double hidden = (1.0 - std::cos(std::atan(0.125))) / (1.0 - std::cos(kSun));
    // The disk's polygon has its area, but not its outline. The cap differs by less than the square of the
    // sun.
    expectEstimate(shareOfSun(world, {0, 0, 0}, random), 1.0 - hidden, 1e-3, 1e-4);
    EXPECT_NEAR(shareBesidesCap(kSun, std::atan(0.125), 0.0), 1.0 - hidden, 1e-12);
}

// The same from beside the disk's axis. Shares of arcs are known in simple cases: a disk that is completely
// within the sun, and the limit of a small sun, where the caps are disks in a plane.
TEST(OracleShadow, OfADiskAsideOfTheSun) {
    SceneFile file;
    file.addDisk(file.addMaterial(diffuseMaterial()), {0, 2, 0}, {0, 1, 0}, 0.25, 256);
    const World world(file.import());
    Random random(6);
    for (const double x : {0.02, 0.1, 0.2, 0.4, 0.6, 0.7}) {
        const double share = shareBesidesDisk(kSun, 0.125, 0.5 * x);
        expectEstimate(shareOfSun(world, {x, 0, 0}, random), share, 1e-3, 1e-4);
    }
    EXPECT_NEAR(shareBesidesDisk(kSun, 0.125, 1e-9),
                1.0 - (1.0 - std::cos(std::atan(0.125))) / (1.0 - std::cos(kSun)), 1e-6);
    EXPECT_EQ(shareBesidesDisk(kSun, 0.125, 1.0), 1.0);
    EXPECT_NEAR(shareBesidesDisk(kSun, 1.0, 0.5), 0.0, 1e-6);
    // For two circles of radius r whose centres are r apart, the lens is 2/3 - sqrt(3) / (2 π) of either.
    EXPECT_NEAR(shareBesidesDisk(1e-4, std::tan(1e-4), std::tan(1e-4)),
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
    const double hidden = (1.0 - std::cos(std::atan(0.05))) / (1.0 - std::cos(cap.halfAngle));
    expectEstimate(visibleShare(world, cap, Vec3(0.0), kClosedFormShadowUp, {kStrata, 4}, random),
                   1.0 - hidden, 1e-3, 1e-4);
}

TEST(OracleShadow, ALampOnTheHorizonIsHiddenByHalf) {
    const World world;
    gltf::Light lamp;
    lamp.type = gltf::LightType::Point;
    lamp.position = {2.0F, 0.0F, 0.0F};
    const LightCap cap = lightCap(lamp, {0.3, 0.0}, Vec3(0.0));
    Random random(5);
    expectEstimate(visibleShare(world, cap, Vec3(0.0), kClosedFormShadowUp, {kStrata, 4}, random), 0.5, 1e-3);
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

// Compares irradiance by quadrature with closed forms.
#include "oracle/expect.h"
#include "oracle/irradiance.h"
#include "oracle/scene_file.h"

namespace {

using namespace glint;
using namespace glint::oracle;

constexpr Vec3 kClosedFormIrradianceUp(0.0, 1.0, 0.0);

TEST(OracleIrradiance, InAClosedWhiteBoxIsTheRadianceOfItsWalls) {
    SceneFile file;
    const int white = file.addMaterial(diffuseMaterial());
    file.addBox({white, white, white, white, white, white}, {-1, 0, -2}, {1, 1, 2}, true);
    const World world(file.import());
    Random random(1);
    const Estimate estimate = irradianceOverPi(
        world, {0.3, 0.0, -1.7}, kClosedFormIrradianceUp, Faces::Culled,
        [](const Hit&, const Ray&) { return Vec3(0.7); }, [](const Vec3&) { return Vec3(100.0); }, {32, 4},
        random);
    EXPECT_NEAR(estimate.mean.x, 0.7, 1e-12) << "no ray leaves the box";
    EXPECT_NEAR(estimate.error.x, 0.0, 1e-12);
}

TEST(OracleIrradiance, OfOneBrightWallIsItsFormFactor) {
    SceneFile file;
    const int white = file.addMaterial(diffuseMaterial());
    const int bright = file.addMaterial(emissiveMaterial({3.0, 2.0, 1.0}));
    // The side at the upper y is the ceiling.
    file.addBox({white, white, white, bright, white, white}, {-1, 0, -2}, {1, 1, 2}, true);
    const World world(file.import());
    Random random(2);
    for (const Vec3& position : {Vec3(0.0), Vec3(0.8, 0.0, -1.5), Vec3(-0.99, 0.0, 1.99)}) {
        const Estimate estimate = irradianceOverPi(
            world, position, kClosedFormIrradianceUp, Faces::Culled,
            [&](const Hit& hit, const Ray&) {
                return hit.material == bright ? Vec3(3.0, 2.0, 1.0) : Vec3(0.0);
            },
            [](const Vec3&) { return Vec3(0.0); }, {128, 4}, random);
        const double factor =
            formFactorOfQuad(position, kClosedFormIrradianceUp, {-1, 1, -2}, {2, 0, 0}, {0, 0, 4});
        expectEstimate(estimate, 3.0 * factor, 2e-3);
        EXPECT_NEAR(estimate.mean.z, estimate.mean.x / 3.0, 1e-12);
        EXPECT_NEAR(estimate.square.x, 9.0 * estimate.mean.x / 3.0, 1e-12);
    }
}

// The point is above a corner of a rectangle a × b, at the height c. This is the catalogue's formula for a
// plane element parallel to a rectangle, with the normal through a corner (Howell, differential element to
// rectangle).
TEST(OracleIrradiance, FormFactorsAreThoseOfTheTables) {
    constexpr double kA = 0.7;
    constexpr double kB = 1.3;
    constexpr double kC = 0.9;
    const double x = kA / kC;
    const double y = kB / kC;
    const double table = (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
                          y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) /
                         (2.0 * kPi);
    EXPECT_NEAR(formFactorOfQuad(Vec3(0.0), kClosedFormIrradianceUp, {0, kC, 0}, {kA, 0, 0}, {0, 0, kB}),
                table, 1e-12);
}

// A sky with a gradient. Upwards: 2 ∫ (h + (z - h) μ) μ dμ = h + 2/3 (z - h). Sideways both halves count
// alike: the mean of |y| under cosine / π about the horizon is 4 / (3 π).
TEST(OracleIrradiance, OfAGradient) {
    const World world;
    const GradientSky sky{Vec3(3.0), Vec3(1.0), Vec3(0.5)};
    Random random(3);
    const auto light = [&](const Vec3& normal) {
        return irradianceOverPi(
            world, Vec3(0.0), normal, Faces::Culled, [](const Hit&, const Ray&) { return Vec3(0.0); }, sky,
            {64, 4}, random);
    };
    expectEstimate(light(kClosedFormIrradianceUp), 1.0 + 2.0 / 3.0 * 2.0, 1e-3);
    expectEstimate(light(-kClosedFormIrradianceUp), 1.0 - 2.0 / 3.0 * 0.5, 1e-3);
    const double sideways = 1.0 + 4.0 / (3.0 * kPi) * (0.5 * (2.0 - 0.5));
    expectEstimate(light({1, 0, 0}), sideways, 1e-3);
}

}  // namespace

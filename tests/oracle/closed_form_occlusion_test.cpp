// Compares ambient occlusion by quadrature with closed forms.
#include "oracle/expect.h"
#include "oracle/occlusion.h"
#include "oracle/scene_file.h"

namespace {

using namespace glint;
using namespace glint::oracle;

constexpr Vec3 kClosedFormOcclusionUp(0.0, 1.0, 0.0);

TEST(OracleOcclusion, OfASphereOverAPlane) {
    World world;
    const Vec3 center(0.2, 0.8, -0.1);
    world.addSphere(center, 0.5);
    Random random(1);
    for (const double x : {-2.0, -0.5, 0.2, 0.7, 1.5}) {
        const Vec3 position(x, 0.0, 0.3);
        const Estimate estimate =
            openness(world, position, kClosedFormOcclusionUp, {}, Faces::Culled, {128, 4}, random);
        expectEstimate(estimate, opennessUnderSphere(position, kClosedFormOcclusionUp, center, 0.5), 5e-4);
        // A ray is either free or not.
        EXPECT_NEAR(estimate.square.x, estimate.mean.x, 1e-12);
    }
}

TEST(OracleOcclusion, OfATouchingSphere) {
    World world;
    world.addSphere({0, 0.5, 0}, 0.5);
    Random random(2);
    for (const double x : {0.05, 0.2, 0.6}) {
        const Vec3 position(x, 0.0, 0.0);
        const Estimate estimate =
            openness(world, position, kClosedFormOcclusionUp, {}, Faces::Culled, {128, 4}, random);
        expectEstimate(estimate, opennessUnderSphere(position, kClosedFormOcclusionUp, {0, 0.5, 0}, 0.5),
                       5e-4);
    }
}

// An infinite ceiling at the height h is hit at t = h / cos θ. Within the radius R the hits fill the cone of
// cosine h / R, and 1/π ∫ cos θ over it is 1 - (h / R)². Weighted by 1 - t / R it is smaller by 2 (h / R) (1
// - h / R).
TEST(OracleOcclusion, OfACeilingByRadiusAndFalloff) {
    SceneFile file;
    const int material = file.addMaterial(diffuseMaterial());
    file.addQuad(material, {-50, 0.5, -50}, {100, 0, 0}, {0, 0, 100});
    const World world(file.import());
    Random random(3);
    for (const double radius : {0.4, 0.6, 1.0, 5.0}) {
        const double ratio = std::min(0.5 / radius, 1.0);
        const Estimate binary = openness(world, Vec3(0.0), kClosedFormOcclusionUp, {radius, false},
                                         Faces::Culled, {128, 4}, random);
        expectEstimate(binary, ratio * ratio, 5e-4);
        const Estimate linear = openness(world, Vec3(0.0), kClosedFormOcclusionUp, {radius, true},
                                         Faces::Culled, {128, 4}, random);
        expectEstimate(linear, ratio * ratio + 2.0 * ratio * (1.0 - ratio), 5e-4);
    }
    // Everything is occluded except what passes 50 m away: less than (0.5 / 50)².
    expectEstimate(openness(world, Vec3(0.0), kClosedFormOcclusionUp, {}, Faces::Culled, {128, 4}, random),
                   0.0, 5e-4, 1e-4);
}

}  // namespace

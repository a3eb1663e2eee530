// Tests what rays hit, and where.
#include "oracle/world.h"

#include "oracle/expect.h"
#include "oracle/scene_file.h"
#include "oracle/view.h"

namespace {

using namespace glint;
using namespace glint::oracle;

TEST(OracleWorld, RaysMeetTrianglesInDoublePrecision) {
    SceneFile file;
    file.addQuad(file.addMaterial(diffuseMaterial()), {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    const World world(file.import());
    // Neither 1/3 nor the distances are numbers of single precision.
    const Ray ray{{1.0 / 3.0, 1.0 / 7.0, 10.0 / 3.0}, glm::normalize(Vec3(0.1, -0.2, -1.0))};
    const std::optional<Hit> hit = world.closest(ray, Faces::Culled);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance, 10.0 / 3.0 * std::sqrt(1.05), 1e-14);
    EXPECT_NEAR(hit->position.x, 1.0 / 3.0 + 1.0 / 3.0, 1e-14);
    EXPECT_NEAR(hit->position.y, 1.0 / 7.0 - 2.0 / 3.0, 1e-14);
    EXPECT_NEAR(hit->position.z, 0.0, 1e-14);
    EXPECT_TRUE(hit->front);
    // A ray that leaves the surface where it starts does not hit it.
    EXPECT_FALSE(world.closest({hit->position, {0, 0, 1}}, Faces::All));
    EXPECT_FALSE(world.closest({hit->position, {0, 0, -1}}, Faces::All));
}

TEST(OracleWorld, BacksOfSingleSidedTrianglesLetRaysPassWhereTheyAreCulled) {
    SceneFile file;
    const int single = file.addMaterial(diffuseMaterial());
    const int both = file.addMaterial(diffuseMaterial(Vec3(1.0), true));
    file.addQuad(single, {-1, -1, 2}, {2, 0, 0}, {0, 2, 0});
    file.addQuad(both, {-1, -1, 3}, {2, 0, 0}, {0, 2, 0});
    const World world(file.import());
    const Ray ray{{0.1, 0.2, 0.0}, {0, 0, 1}};
    const std::optional<Hit> culled = world.closest(ray, Faces::Culled);
    ASSERT_TRUE(culled);
    EXPECT_NEAR(culled->distance, 3.0, 1e-14);
    EXPECT_FALSE(culled->front);
    EXPECT_EQ(culled->material, both);
    const std::optional<Hit> all = world.closest(ray, Faces::All);
    ASSERT_TRUE(all);
    EXPECT_NEAR(all->distance, 2.0, 1e-14);
    EXPECT_FALSE(world.closest(ray, Faces::All, 1.9));
    EXPECT_FALSE(world.visible(ray, 2.1));
    EXPECT_TRUE(world.visible(ray, 1.9));
}

TEST(OracleWorld, SpheresAndTheirTrianglesAgree) {
    SceneFile file;
    constexpr int kRings = 200;
    file.addSphere(file.addMaterial(diffuseMaterial()), {0, 1, 0}, 0.5, kRings);
    const World facets(file.import());
    World sphere;
    sphere.addSphere({0, 1, 0}, 0.5);
    // A facet lies at most this far below the sphere: half the square of half its diagonal, over the radius.
    const double sag = 0.5 * 0.5 * std::pow(std::numbers::sqrt2 * 0.5 * kPi / kRings, 2.0);
    Random random(1);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 from(3.0 * random.next() - 1.5, 4.0, 3.0 * random.next() - 1.5);
        const Vec3 to(random.next() - 0.5, 0.5 + random.next(), random.next() - 0.5);
        const Ray ray{from, glm::normalize(to - from)};
        const std::optional<Hit> a = facets.closest(ray, Faces::Culled);
        const std::optional<Hit> b = sphere.closest(ray, Faces::Culled);
        if (!a) {
            continue;
        }
        ASSERT_TRUE(b) << "the facets are inside the sphere";
        ++hits;
        const double cosine = -glm::dot(ray.direction, b->normal);
        EXPECT_GE(a->distance, b->distance - 1e-6);
        if (cosine > 0.2) {
            EXPECT_LE(a->distance, b->distance + 1.5 * sag / cosine);
            EXPECT_LE(glm::length(a->normal - b->normal), 1e-3);
        }
        // The ray leaves on the far side.
        const Ray onwards{b->position, ray.direction};
        const std::optional<Hit> exit = sphere.closest(onwards, Faces::All);
        ASSERT_TRUE(exit);
        EXPECT_FALSE(exit->front);
        EXPECT_NEAR(exit->distance, cosine, 1e-12) << "the chord is 2 r cos";
        EXPECT_FALSE(sphere.closest(onwards, Faces::Culled));
    }
    EXPECT_GT(hits, 500);
}

TEST(OracleWorld, CornersOfTheImageAreAtTheFieldOfView) {
    SceneFile file;
    file.addCamera({1, 2, 3}, {1, 2, -5}, 60.0);
    const gltf::Scene scene = file.import();
    ASSERT_EQ(scene.cameras.size(), 1U);
    const View view(scene.cameras[0], 40, 20);
    const Ray middle = view.ray(20, 10);
    EXPECT_NEAR(glm::length(middle.direction - Vec3(0, 0, -1)), 0.0, 1e-7);
    EXPECT_NEAR(glm::length(middle.origin - Vec3(1, 2, 3)), 0.0, 1e-7);
    const Vec3 corner = view.ray(0, 0).direction;
    const double half = std::tan(kPi / 6.0);
    EXPECT_NEAR(corner.x / -corner.z, -2.0 * half, 1e-6) << "the first pixel is left";
    EXPECT_NEAR(corner.y / -corner.z, half, 1e-6) << "and on top";
}

TEST(OracleQuadrature, ErrorsFallAsTheyAreSaidTo) {
    // The smooth function is ∫ sin(πx) eʸ; the one with an edge is a quarter disk. The error of the first
    // falls as strata⁻², that of the second as strata^-1.5.
    const double smooth = 2.0 / kPi * (std::numbers::e - 1.0);
    const auto rootMeanSquare = [](int strata, double truth, const auto& f) {
        double squares = 0.0;
        double stated = 0.0;
        constexpr int kSeeds = 64;
        for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
            Random random(seed);
            const Estimate estimate = average({strata, 4}, random, f);
            squares += std::pow(estimate.mean.x - truth, 2.0) / kSeeds;
            stated += estimate.error.x * estimate.error.x / kSeeds;
        }
        // 64 seeds give the ratio of the two to about 20 %.
        EXPECT_NEAR(std::sqrt(stated / squares), 1.0, 0.4);
        return std::sqrt(squares);
    };
    const auto wave = [](Vec2 p) { return Vec3(std::sin(kPi * p.x) * std::exp(p.y)); };
    const auto disk = [](Vec2 p) { return Vec3(glm::dot(p, p) < 1.0 ? 1.0 : 0.0); };
    const double waveRatio = rootMeanSquare(4, smooth, wave) / rootMeanSquare(32, smooth, wave);
    EXPECT_NEAR(std::log2(waveRatio) / 3.0, 2.0, 0.25);
    const double diskRatio = rootMeanSquare(4, 0.25 * kPi, disk) / rootMeanSquare(32, 0.25 * kPi, disk);
    EXPECT_NEAR(std::log2(diskRatio) / 3.0, 1.5, 0.25);
}

TEST(OracleQuadrature, DirectionsHaveTheirDensities) {
    Random random(3);
    // Means of the cosine: 2/3 under cosine / π, and (1 + cos a) / 2 over a cap.
    const Estimate cosine = average({64, 4}, random, [](Vec2 p) { return Vec3(cosineDirection(p).z); });
    expectEstimate(cosine, 2.0 / 3.0, 1e-4);
    for (const double angle : {0.004, 0.3, 1.2}) {
        const Estimate cap = average({64, 4}, random, [&](Vec2 p) {
            const Vec3 direction = capDirection(p, angle);
            EXPECT_NEAR(glm::length(direction), 1.0, 1e-12);
            return Vec3(direction.z);
        });
        expectEstimate(cap, 0.5 * (1.0 + std::cos(angle)), 1e-4);
    }
}

}  // namespace

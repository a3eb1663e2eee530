// Compares paths through dielectrics with Snell, Beer, Fresnel and sums of series.
#include "oracle/refraction.h"
#include "oracle/scene_file.h"

#include <gtest/gtest.h>

namespace {

using namespace glint;
using namespace glint::oracle;

Vec3 black(const Hit& /*hit*/, const Ray& /*ray*/) {
    return Vec3(0.0);
}

DielectricOf always(const Dielectric& dielectric) {
    return [&dielectric](int) { return &dielectric; };
}

Ray falling(double angle) {
    return {Vec3(-std::sin(angle), std::cos(angle), 0.0) * 3.0, {std::sin(angle), -std::cos(angle), 0.0}};
}

// Returns a slab between y = 0 and y = -0.4 that is wide enough for every path.
World slab() {
    SceneFile file;
    const int glass = file.addMaterial(glassMaterial({}));
    file.addQuad(glass, {-500, 0, 500}, {1000, 0, 0}, {0, 0, -1000});
    file.addQuad(glass, {-500, -0.4, -500}, {1000, 0, 0}, {0, 0, 1000});
    return World(file.import());
}

TEST(OracleRefraction, FresnelHasItsKnownValues) {
    for (const Fresnel fresnel : {Fresnel::Exact, Fresnel::Schlick}) {
        EXPECT_NEAR(reflectance(fresnel, 1.0, 1.5, 1.0), 0.04, 1e-12);
        EXPECT_NEAR(reflectance(fresnel, 1.5, 1.0, 1.0), 0.04, 1e-12);
        EXPECT_NEAR(reflectance(fresnel, 1.0, 1.5, 0.0), 1.0, 1e-12);
        const double critical = std::sqrt(1.0 - 1.0 / 2.25);
        EXPECT_EQ(reflectance(fresnel, 1.5, 1.0, critical - 1e-9), 1.0);
        EXPECT_LT(reflectance(fresnel, 1.5, 1.0, critical + 1e-2), 0.7);
        // The reflectance is the same from both sides of the interface.
        const double outside = std::cos(0.7);
        const double inside = std::sqrt(1.0 - std::pow(std::sin(0.7) / 1.5, 2.0));
        EXPECT_NEAR(reflectance(fresnel, 1.0, 1.5, outside), reflectance(fresnel, 1.5, 1.0, inside), 1e-12);
    }
    // At Brewster's angle only the perpendicular part is left, ((n² - 1) / (n² + 1))² / 2.
    const double brewster = std::atan(1.5);
    EXPECT_NEAR(reflectance(Fresnel::Exact, 1.0, 1.5, std::cos(brewster)),
                0.5 * std::pow((2.25 - 1.0) / (2.25 + 1.0), 2.0), 1e-12);
}

// The exact sum over internal reflections: (1 - F)² a / (1 - F² a²) goes through, (1 - F)² F a² / (1 - F² a²)
// goes back.
TEST(OracleRefraction, ASlabIsASeries) {
    const World world = slab();
    const Dielectric glass{Vec3(1.5), absorptionOf({0.2, 0.5, 0.9}, 0.3)};
    const GradientSky fromBelow{Vec3(0.0), Vec3(0.0), Vec3(1.0)};
    const GradientSky fromAbove{Vec3(1.0), Vec3(0.0), Vec3(0.0)};
    for (const Fresnel fresnel : {Fresnel::Exact, Fresnel::Schlick}) {
        for (const double angle : {0.0, 0.5, 1.2, 1.5}) {
            const Ray ray = falling(angle);
            const std::optional<Hit> hit = world.closest(ray, Faces::Culled);
            ASSERT_TRUE(hit);
            const double inside = std::sqrt(1.0 - std::pow(std::sin(angle) / 1.5, 2.0));
            const double f = reflectance(fresnel, 1.0, 1.5, std::cos(angle));
            const RefractionSettings settings{fresnel, 1000, 1e-9};
            const RefractedLight through =
                refractedLight(world, ray, *hit, always(glass), black, fromBelow, settings);
            const RefractedLight back =
                refractedLight(world, ray, *hit, always(glass), black, fromAbove, settings);
            for (int channel = 0; channel < 3; ++channel) {
                const double a = std::exp(-glass.absorption[channel] * 0.4 / inside);
                const double series = (1.0 - f) * (1.0 - f) * a / (1.0 - f * f * a * a);
                // The sky is as bright as the direction is steep, and the slab does not change the direction.
                EXPECT_NEAR(through.radiance[channel], series * std::cos(angle), 1e-7);
                EXPECT_NEAR(back.radiance[channel], series * f * a * std::cos(angle), 1e-7);
                EXPECT_LE(through.left[channel], 1e-7);
            }
        }
    }
}

// A ray through a slab is displaced by t sin(θ - θ') / cos θ'.
TEST(OracleRefraction, ASlabDisplaces) {
    SceneFile file;
    const int glassy = file.addMaterial(glassMaterial({}));
    const int floor = file.addMaterial(unlitMaterial());
    file.addQuad(glassy, {-500, 0, 500}, {1000, 0, 0}, {0, 0, -1000});
    file.addQuad(glassy, {-500, -0.4, -500}, {1000, 0, 0}, {0, 0, 1000});
    file.addQuad(floor, {-500, -1, 500}, {1000, 0, 0}, {0, 0, -1000});
    const World world(file.import());
    const Dielectric glass{Vec3(1.3, 1.5, 1.7), Vec3(0.0)};
    const double angle = 0.9;
    const Ray ray = falling(angle);
    const std::optional<Hit> hit = world.closest(ray, Faces::Culled);
    ASSERT_TRUE(hit);
    for (int channel = 0; channel < 3; ++channel) {
        std::vector<double> places;
        refractedLight(
            world, ray, *hit, [&](int material) { return material == glassy ? &glass : nullptr; },
            [&](const Hit& found, const Ray&) {
                places.push_back(found.position.x);
                return Vec3(1.0);
            },
            [](const Vec3&) { return Vec3(0.0); }, RefractionSettings{});
        const double inner = std::asin(std::sin(angle) / glass.ior[channel]);
        const double straight = std::tan(angle) * 1.0;
        const double shift = 0.4 * std::sin(angle - inner) / std::cos(inner);
        const auto nearest = [&](double x) {
            double best = 1e9;
            for (const double place : places) {
                best = std::min(best, std::abs(place - x));
            }
            return best;
        };
        EXPECT_LT(nearest(straight - shift / std::cos(angle)), 1e-6);
    }
}

// The ray meets a sphere's inside always at the first angle: chords are 2 r cos θ', each crossing turns it by
// θ - θ', and each reflection by π - 2 θ'.
TEST(OracleRefraction, ASphereTurnsLightByKnownAngles) {
    World world;
    world.addSphere(Vec3(0.0), 0.8);
    const Dielectric glass{Vec3(1.5), Vec3(0.7)};
    for (const double height : {0.0, 0.3, 0.6, 0.75}) {
        const Ray ray{{height, 5.0, 0.0}, {0, -1, 0}};
        const std::optional<Hit> hit = world.closest(ray, Faces::Culled);
        ASSERT_TRUE(hit);
        const double theta = std::asin(height / 0.8);
        const double inner = std::asin(std::sin(theta) / 1.5);
        const double f = reflectance(Fresnel::Exact, 1.0, 1.5, std::cos(theta));
        const double a = std::exp(-0.7 * 2.0 * 0.8 * std::cos(inner));
        const auto sky = [](const Vec3& d) { return Vec3(1.0 + d.x, 1.0 + d.y, 1.0); };
        const RefractedLight light =
            refractedLight(world, ray, *hit, always(glass), black, sky, {Fresnel::Exact, 100, 1e-9});
        Vec3 expected(0.0);
        double weight = (1.0 - f) * (1.0 - f) * a;
        // The direction is an angle from -y towards -x: a ray beside the axis turns towards it.
        double turned = 2.0 * (theta - inner);
        for (int order = 0; order < 60; ++order) {
            expected += weight * sky({-std::sin(turned), -std::cos(turned), 0.0});
            weight *= f * a;
            turned += kPi - 2.0 * inner;
        }
        for (int channel = 0; channel < 3; ++channel) {
            EXPECT_NEAR(light.radiance[channel], expected[channel], 1e-7) << "height " << height;
        }
    }
}

// Tests rough interfaces. If nearly smooth, the light is that of the smooth interface. At the index 1 nothing
// bends or is reflected, and only the light that facets hide from each other is missing.
TEST(OracleRefraction, ARoughInterfaceHasItsLimits) {
    const World world;
    const auto sky = [](const Vec3& d) { return Vec3(1.0 - d.y, 1.0, 1.0 + d.x); };
    const Hit hit{0.0, Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 1, 0), Vec3(1.0), 0, true};
    Random random(1);
    for (const double angle : {0.0, 0.6, 1.2}) {
        const Ray ray{Vec3(0.0), {std::sin(angle), -std::cos(angle), 0.0}};
        const Dielectric glass{Vec3(1.5), Vec3(0.0)};
        const Estimate nearlySmooth =
            roughlyRefractedLight(world, ray, hit, 1e-5, glass, Fresnel::Exact, black, sky, {8, 4}, random);
        Vec3 inward;
        ASSERT_TRUE(refracted(ray.direction, hit.normal, 1.0, 1.5, inward));
        const double passes = 1.0 - reflectance(Fresnel::Exact, 1.0, 1.5, std::cos(angle));
        for (int channel = 0; channel < 3; ++channel) {
            EXPECT_NEAR(nearlySmooth.mean[channel], passes * sky(inward)[channel], 1e-4);
        }
        // From air to air: the light goes straight on, masked by Λ of both sides, which are equal.
        const Dielectric air{Vec3(1.0), Vec3(0.0)};
        const double alpha = 0.5;
        const double tangent = std::tan(angle);
        const double lambda = 0.5 * (std::sqrt(1.0 + alpha * alpha * tangent * tangent) - 1.0);
        const Estimate straight =
            roughlyRefractedLight(world, ray, hit, alpha, air, Fresnel::Exact, black, sky, {8, 4}, random);
        EXPECT_NEAR(straight.mean.y, (1.0 + lambda) / (1.0 + 2.0 * lambda), 1e-9);
    }
}

// The same integral over all facets by their own distribution, cos θ D of GGX, whether they are visible or
// not: Walter et al. 2007, equation 21, as an integral over half vectors.
TEST(OracleRefraction, ARoughInterfaceIsTheIntegralOverItsFacets) {
    const World world;
    const auto sky = [](const Vec3& d) { return Vec3(1.0 - d.y, 1.0, 1.0 + d.x); };
    const Hit hit{0.0, Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 1, 0), Vec3(1.0), 0, true};
    const Dielectric glass{Vec3(1.5), Vec3(0.0)};
    Random random(2);
    for (const double alpha : {0.1, 0.6}) {
        for (const double angle : {0.3, 1.3}) {
            const Ray ray{Vec3(0.0), {std::sin(angle), -std::cos(angle), 0.0}};
            const Estimate byVisible = roughlyRefractedLight(world, ray, hit, alpha, glass, Fresnel::Schlick,
                                                             black, sky, {96, 4}, random);
            const auto lambda = [&](double cosine) {
                return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 / (cosine * cosine) - 1.0)) - 1.0);
            };
            const Estimate byAll = average({256, 4}, random, [&](Vec2 point) {
                const double tangent = alpha * std::sqrt(point.x / (1.0 - point.x));
                const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
                const double phi = 2.0 * kPi * point.y;
                const Vec3 facet = cosine * Vec3(tangent * std::cos(phi), 1.0, tangent * std::sin(phi));
                const double seen = -glm::dot(ray.direction, facet);
                Vec3 inward;
                if (seen <= 0.0 || !refracted(ray.direction, facet, 1.0, 1.5, inward) || inward.y >= 0.0) {
                    return Vec3(0.0);
                }
                const double passes = 1.0 - reflectance(Fresnel::Schlick, 1.0, 1.5, seen);
                const double unmasked = 1.0 / (1.0 + lambda(std::cos(angle)) + lambda(inward.y));
                return passes * unmasked * seen / (std::cos(angle) * cosine) * sky(inward);
            });
            for (int channel = 0; channel < 3; ++channel) {
                const double error = std::hypot(byVisible.error[channel], byAll.error[channel]);
                EXPECT_LE(error, 5e-3);
                EXPECT_NEAR(byVisible.mean[channel], byAll.mean[channel], 5.0 * error)
                    << "alpha " << alpha << ", angle " << angle;
            }
        }
    }
}

// Without absorption, all light that enters comes out.
TEST(OracleRefraction, EnergyIsKept) {
    SceneFile file;
    const int glassy = file.addMaterial(glassMaterial({}));
    file.addBox(std::vector<int>(6, glassy), {-1, -1, -1}, {1, 1, 1}, false);
    const World world(file.import());
    const Dielectric glass{Vec3(1.2, 1.5, 2.4), Vec3(0.0)};
    const Ray ray{{0.31, 4.0, 1.17}, glm::normalize(Vec3(0.11, -1.0, -0.22))};
    const std::optional<Hit> hit = world.closest(ray, Faces::Culled);
    ASSERT_TRUE(hit);
    const RefractedLight light =
        refractedLight(world, ray, *hit, always(glass), black, [](const Vec3&) { return Vec3(1.0); },
                       {Fresnel::Exact, 60, 1e-9});
    for (int channel = 0; channel < 3; ++channel) {
        const double f =
            reflectance(Fresnel::Exact, 1.0, glass.ior[channel], -glm::dot(ray.direction, hit->normal));
        EXPECT_NEAR(light.radiance[channel] + light.left[channel], 1.0 - f, 1e-12);
        EXPECT_LT(light.left[channel], 0.3) << "total reflection keeps some for long";
    }
}

}  // namespace

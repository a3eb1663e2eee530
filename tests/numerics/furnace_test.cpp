// Tests energy and reciprocity of the BSDF in double precision, against analytic values and a quadrature that
// shares no code with the shaders.
#include "ggx_table.h"
#include "materials.h"
#include "support/nightly.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace glint::numerics {
namespace {

constexpr std::array kCosines{0.02, 0.1, 0.3, 0.7, 1.0};
constexpr std::uint64_t kSeed = 20240601;

// Returns the albedo of white microfacets, each of which reflects once.
double singleScatterAlbedo(double alpha, double cosine, int points) {
    glsl::energyCompensation = 0;
    TestMaterial material = makeMaterial(alpha);
    material.bsdf.base.f0 = glm::dvec3(1.0);
    const double result = albedo(material.seenFrom(direction(cosine, 0.4)), points).x;
    glsl::energyCompensation = 1;
    return result;
}

TEST(Ggx, DistributionIntegratesToOneOverProjectedArea) {
    for (const double alpha : {1e-4, 1e-3, 0.01, 0.1, 0.5, 1.0}) {
        // The substitution t = tan θ / α keeps the peak resolved: ∫ D cos θ dω = 2π ∫ D cos⁴θ α² t dt. The
        // tail beyond t = 1000 is 1 / (1 + t²).
        constexpr int kSteps = 20000;
        constexpr double kEnd = 1e3;
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            // Quadratic spacing is dense where the integrand is large.
            const double s = (i + 0.5) / kSteps;
            const double t = kEnd * s * s;
            const double dt = 2.0 * kEnd * s / kSteps;
            const double cosine = 1.0 / std::sqrt(1.0 + alpha * alpha * t * t);
            const double sine = alpha * t * cosine;
            const glm::dvec3 h(sine * std::cos(0.3), sine * std::sin(0.3), cosine);
            sum += 2.0 * kPi * glsl::ggxDistribution(h, glm::dvec2(alpha)) * std::pow(cosine, 4) * alpha *
                   alpha * t * dt;
        }
        EXPECT_NEAR(sum, 1.0, 1e-5) << "alpha " << alpha;
    }
}

TEST(Ggx, SingleScatterAlbedoHasTheAnalyticValueAtAlphaOne) {
    for (const double mu : {0.1, 0.3, 0.7, 1.0}) {
        EXPECT_NEAR(singleScatterAlbedo(1.0, mu, 20000), 1.0 - mu * std::log(1.0 + 1.0 / mu), 3e-4)
            << "mu " << mu;
    }
}

TEST(Ggx, SingleScatterAlbedoAgreesWithTheTable) {
    if (!std::filesystem::exists(ggxTablePath())) {
        GTEST_SKIP() << test::noModels(ggxTablePath());
    }
    const std::vector<GgxAlbedoEntry> table = readGgxTable();
    EXPECT_FALSE(table.empty());
    for (const GgxAlbedoEntry& entry : table) {
        EXPECT_NEAR(singleScatterAlbedo(entry.alpha, entry.cosine, 20000), entry.albedo, 3e-4)
            << "alpha " << entry.alpha << ", mu " << entry.cosine;
    }
}

// Returns the share of a white sky that black microfacets (f0 = 0, f90 = 1) or white ones reflect once.
double reflectedOnce(TestMaterial material, double f0, const glm::dvec3& view) {
    glsl::energyCompensation = 0;
    material.bsdf.base.f0 = glm::dvec3(f0);
    const double result = albedo(material.seenFrom(view), 8000).x;
    glsl::energyCompensation = 1;
    return result;
}

// The bounds are those that albedo.glsl states.
TEST(Ggx, AnisotropicAlbedoIsWithinItsBounds) {
    Engine engine(kSeed);
    for (int i = 0; i < 400; ++i) {
        TestMaterial material = makeMaterial(randomAlpha(engine, 1e-3));
        material.lobes = GLINT_ANISOTROPY;
        material.bsdf.base.alpha.x =
            anisotropicAlpha(material.bsdf.base.alpha.y, i % 3 == 0 ? 1.0 : uniform(engine));
        const double cosine = i % 2 == 0 ? std::exp(uniform(engine, std::log(1e-3), 0.0)) : uniform(engine);
        const glm::dvec3 view = direction(cosine, uniform(engine, 0.0, 2.0 * kPi));
        const TestMaterial seen = material.seenFrom(view);
        const double white = 1.0 - seen.bsdf.base.viewLoss - reflectedOnce(material, 1.0, view);
        const double weighted = seen.bsdf.base.viewBias - reflectedOnce(material, 0.0, view);
        EXPECT_GE(white, -2.5e-3) << seen;
        EXPECT_LE(white, cosine < 0.05 ? 1.8e-2 : 1e-2) << seen;
        EXPECT_GE(weighted, -2.5e-3) << seen;
        EXPECT_LE(weighted, 6e-2) << seen;
    }
}

TEST(Furnace, WhiteMetalReflectsEverything) {
    for (const double roughness : {0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0}) {
        TestMaterial metal = makeMaterial(roughness * roughness);
        metal.bsdf.base.f0 = glm::dvec3(1.0);
        for (const double cosine : kCosines) {
            const double reflected = albedo(metal.seenFrom(direction(cosine, 0.4)), 20000).x;
            EXPECT_NEAR(reflected, 1.0, 0.01) << "roughness " << roughness << ", cosine " << cosine;
            EXPECT_LE(reflected, 1.001) << "roughness " << roughness << ", cosine " << cosine;
        }
    }
}

// glTF 2.0, appendix B.1: a base that is part metal is a mix of two BSDFs, whatever lies on top of it.
TEST(Furnace, APartialMetalIsAMixOfTwoBases) {
    Engine engine(kSeed);
    for (int i = 0; i < 2000; ++i) {
        TestMaterial dielectric = randomMaterial(
            engine, GLINT_ANISOTROPY | GLINT_TRANSMISSION | GLINT_VOLUME | GLINT_DIFFUSE_TRANSMISSION);
        dielectric.inputs = 0;
        TestMaterial metal = dielectric;
        metal.bsdf.base.f0 = colour(engine);
        metal.bsdf.base.f90 = 1.0;
        metal.bsdf.diffuse = metal.bsdf.base.transmitted = metal.bsdf.diffuseTransmitted = glm::dvec3(0.0);
        metal.lobes &= GLINT_ANISOTROPY;
        const double share = uniform(engine);
        TestMaterial both = dielectric;
        both.inputs = GLINT_PARTIAL_METAL;
        both.bsdf.base.metalF0 = metal.bsdf.base.f0;
        both.bsdf.base.metallic = share;
        for (glm::dvec3* const lobe :
             {&both.bsdf.diffuse, &both.bsdf.base.transmitted, &both.bsdf.diffuseTransmitted}) {
            *lobe *= 1.0 - share;
        }
        const glm::dvec3 view = direction(uniform(engine, 0.01, 1.0), uniform(engine, 0.0, 2.0 * kPi));
        const glm::dvec3 light = direction(uniform(engine, -1.0, 1.0), uniform(engine, 0.0, 2.0 * kPi));
        const glm::dvec3 truth =
            glm::mix(dielectric.seenFrom(view).evaluate(light), metal.seenFrom(view).evaluate(light), share);
        ASSERT_LE(glm::length(both.seenFrom(view).evaluate(light) - truth),
                  1e-12 * (1.0 + glm::length(truth)))
            << both;
    }
}

TEST(Furnace, WhitePartialMetalReflectsEverything) {
    for (const double metallic : {0.0, 0.1, 0.25, 0.5, 0.75, 1.0}) {
        for (const double roughness : {0.1, 0.3, 0.5, 0.75, 1.0}) {
            for (const bool passes : {false, true}) {
                TestMaterial material = makeMaterial(roughness * roughness);
                material.inputs = GLINT_PARTIAL_METAL;
                material.bsdf.base.f0 = glm::dvec3(0.04);
                material.bsdf.base.metalF0 = glm::dvec3(1.0);
                material.bsdf.base.metallic = metallic;
                glm::dvec3& lobe = passes ? material.bsdf.diffuseTransmitted : material.bsdf.diffuse;
                lobe = glm::dvec3(1.0 - metallic);
                material.lobes = passes ? GLINT_DIFFUSE_TRANSMISSION : 0U;
                for (const double cosine : {0.1, 0.5, 1.0}) {
                    EXPECT_NEAR(albedo(material.seenFrom(direction(cosine, 0.4)), 20000).x, 1.0, 0.01)
                        << "metallic " << metallic << ", roughness " << roughness << ", cosine " << cosine
                        << (passes ? ", light passes" : "");
                }
            }
        }
    }
}

// The lobe at the first bounce comes from a quadrature; only what compensation adds comes from fits.
TEST(Furnace, WhiteAnisotropicMetalReflectsEverything) {
    for (const double roughness : {0.05, 0.15, 0.3, 0.5, 0.7, 0.9}) {
        for (const double strength : {0.2, 0.5, 0.75, 1.0}) {
            TestMaterial metal = makeMaterial(roughness * roughness);
            metal.lobes = GLINT_ANISOTROPY;
            metal.bsdf.base.f0 = glm::dvec3(1.0);
            metal.bsdf.base.alpha.x = anisotropicAlpha(metal.bsdf.base.alpha.y, strength);
            int view = 0;
            for (const double cosine : {0.05, 0.15, 0.4, 0.75, 1.0}) {
                for (const double phi : {0.0, 0.4, 0.8, 1.2, 1.5707}) {
                    // Half of the azimuths, others for the next cosine, stand for all by day.
                    if (!test::nightly() && ++view % 2 == 0) {
                        continue;
                    }
                    const double reflected = albedo(metal.seenFrom(direction(cosine, phi)), 20000).x;
                    const auto where = [&] {
                        return "roughness " + std::to_string(roughness) + ", strength " +
                               std::to_string(strength) + ", cosine " + std::to_string(cosine) +
                               ", azimuth " + std::to_string(phi);
                    };
                    EXPECT_NEAR(reflected, 1.0, 0.01) << where();
                    EXPECT_LE(reflected, 1.002) << where();
                }
            }
        }
    }
}

TEST(Furnace, NothingReflectsMoreThanItReceives) {
    Engine engine(kSeed);
    // All lobes except Unlit and SpecularGlossiness.
    constexpr glsl::uint kAll = GLINT_CLEARCOAT | GLINT_SHEEN | GLINT_ANISOTROPY | GLINT_TRANSMISSION |
                                GLINT_DIFFUSE_TRANSMISSION | GLINT_VOLUME | GLINT_DISPERSION;
    int failures = 0;
    const int count = test::nightly() ? 2000 : 700;
    for (int i = 0; i < count && failures < 5; ++i) {
        const double cosine =
            i % 4 == 0 ? std::exp(uniform(engine, std::log(1e-4), 0.0)) : uniform(engine, 1e-3, 1.0);
        const TestMaterial seen =
            randomMaterial(engine, kAll).seenFrom(direction(cosine, uniform(engine, 0.0, 2.0 * kPi)));
        // If the coat's normal turns away from the view, it has no visible normals that the quadrature could
        // follow.
        if (seen.has(GLINT_CLEARCOAT) && glm::dot(seen.bsdf.layers.clearcoat.normal, seen.bsdf.view) < 0.01) {
            continue;
        }
        double most = largestOf(albedo(seen, 256));
        // A coarse sum decides most cases; a result near the limit is summed finely.
        if (most > 0.98) {
            most = largestOf(albedo(seen, 20000));
        }
        // The light that a rough volume passes from outside is an estimate (see the tests of glass below).
        const double bound = seen.has(GLINT_VOLUME) && seen.bsdf.base.eta.y > 1.0 ? 1.011 : 1.001;
        EXPECT_LE(most, bound) << "material " << i << " of seed " << kSeed << ": " << seen;
        failures += most > bound ? 1 : 0;
    }
}

// The mean weight of the samples of a glass's interface: what it reflects and transmits in all.
double meanWeight(const TestMaterial& seen) {
    constexpr int kSamples = 50000;
    // Roberts's additive sequence: powers of the root of x⁴ = x + 1.
    constexpr glm::dvec3 kStep(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
    double sum = 0.0;
    for (int i = 0; i < kSamples; ++i) {
        const glm::dvec3 u = glm::fract(glm::dvec3(0.5) + (i + 1.0) * kStep);
        sum += glsl::sampleBsdf(seen.bsdf, seen.features(), u).weight.y;
    }
    return sum / kSamples;
}

// Clear glass loses nothing at an interface, from either side, however rough it is; neither does a thin wall.
TEST(Furnace, GlassReflectsAndTransmitsEverything) {
    for (const double roughness : {0.05, 0.3, 0.5, 0.7, 1.0}) {
        for (const double cosine : {0.01, 0.1, 0.3, 0.6, 0.95}) {
            for (const double eta : {1.5, 1.0 / 1.5, 1.1, 0.0}) {
                const bool thin = eta == 0.0;
                TestMaterial material = makeMaterial(roughness * roughness);
                material.lobes = thin ? GLINT_TRANSMISSION : GLINT_TRANSMISSION | GLINT_VOLUME;
                material.bsdf.base.eta = glm::dvec3(eta);
                material.bsdf.base.f0 = glm::dvec3(glsl::dielectricF0(thin ? 1.5 : eta));
                material.bsdf.base.transmitted = glm::dvec3(1.0);
                const double whole = meanWeight(material.seenFrom(direction(cosine, 0.4)));
                // From outside, the sum is as exact as the fits of the reflection's albedo, and for a volume
                // as the estimate of what its visible facets pass.
                EXPECT_NEAR(whole, 1.0,
                            thin        ? 7e-3
                            : eta < 1.0 ? 1e-3
                                        : 1.1e-2)
                    << "roughness " << roughness << ", cosine " << cosine << ", eta " << eta;
            }
        }
    }
}

// The fits of an anisotropic reflection are less exact for oblique views, and so is what they leave to pass.
TEST(Furnace, AnisotropicGlassReflectsAndTransmitsNearlyEverything) {
    for (const double roughness : {0.05, 0.3, 0.7}) {
        for (const double strength : {0.3, 0.6, 1.0}) {
            for (const double cosine : {0.02, 0.1, 0.5, 0.95}) {
                for (const double phi : {0.0, 0.8, 1.45, 1.57}) {
                    TestMaterial material = makeMaterial(roughness * roughness);
                    material.lobes = GLINT_TRANSMISSION | GLINT_VOLUME | GLINT_ANISOTROPY;
                    material.bsdf.base.alpha.x = anisotropicAlpha(material.bsdf.base.alpha.y, strength);
                    material.bsdf.base.eta = glm::dvec3(1.5);
                    material.bsdf.base.f0 = glm::dvec3(0.04);
                    material.bsdf.base.transmitted = glm::dvec3(1.0);
                    EXPECT_NEAR(meanWeight(material.seenFrom(direction(cosine, phi))), 1.0,
                                strength < 0.5 ? 2e-2 : 6e-2)
                        << "roughness " << roughness << ", strength " << strength << ", cosine " << cosine
                        << ", azimuth " << phi;
                }
            }
        }
    }
}

// Returns f(v, l) of a material, without the cosine. Both directions may be on either side.
glm::dvec3 valueOf(const TestMaterial& material, glm::dvec3 view, glm::dvec3 light) {
    if (view.z < 0.0) {  // a wall that is the same from both sides
        view.z = -view.z;
        light.z = -light.z;
    }
    return material.seenFrom(view).evaluate(light) / std::abs(light.z);
}

void expectReciprocity(glsl::uint lobes, bool passes) {
    Engine engine(kSeed + lobes);
    int compared = 0;
    for (int i = 0; i < 20000; ++i) {
        TestMaterial material = randomMaterial(engine, 0, 0.01);
        material.lobes = lobes;
        glsl::Bsdf& b = material.bsdf;
        b.base.transmitted = colour(engine);
        b.diffuseTransmitted = colour(engine);
        if ((lobes & GLINT_ANISOTROPY) != 0U) {
            b.base.alpha.x = anisotropicAlpha(b.base.alpha.y, uniform(engine));
        }
        const glm::dvec3 view = direction(uniform(engine, 0.01, 1.0), uniform(engine, 0.0, 2.0 * kPi));
        const double side = passes ? -1.0 : 1.0;
        // Half of the directions are near the mirror direction.
        const glm::dvec3 light =
            i % 2 == 0 ? direction(side * uniform(engine, 0.01, 1.0), uniform(engine, 0.0, 2.0 * kPi))
                       : glm::normalize(glm::dvec3(-view.x + 0.1 * uniform(engine),
                                                   -view.y + 0.1 * uniform(engine), side * view.z));
        const glm::dvec3 forth = valueOf(material, view, light);
        const glm::dvec3 back = valueOf(material, light, view);
        const double largest = std::max(largestOf(forth), largestOf(back));
        if (largest > 1e-12) {
            ++compared;
            ASSERT_LE(glm::length(forth - back), 1e-4 * largest)
                << material << ", view (" << view.x << ", " << view.y << ", " << view.z << "), light ("
                << light.x << ", " << light.y << ", " << light.z << ")";
        }
    }
    EXPECT_GT(compared, 1000);
}

TEST(Reciprocity, HoldsForDiffuseAndMicrofacets) {
    expectReciprocity(0, false);
    expectReciprocity(GLINT_ANISOTROPY, false);
}

TEST(Reciprocity, HoldsUnderSheen) {
    expectReciprocity(GLINT_SHEEN, false);
}

TEST(Reciprocity, HoldsForThinWalls) {
    expectReciprocity(GLINT_TRANSMISSION, true);
    expectReciprocity(GLINT_DIFFUSE_TRANSMISSION, true);
}

}  // namespace
}  // namespace glint::numerics

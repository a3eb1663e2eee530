// The BSDF functions of shaders/, in double precision, against analytic truths and quadrature that share no
// code with them.
#include "numerics/glsl_double.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

// The shader text compiles inside glsl; the keyword means double here.
#define float double
namespace glsl {
#include "bsdf/constants.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/ggx.glsl"
}  // namespace glsl
#undef float

namespace {

using glsl::vec3;

constexpr double kPi = std::numbers::pi;

vec3 direction(double cosTheta, double phi) {
    const double sinTheta = std::sqrt(std::max(0.0, 1.0 - cosTheta * cosTheta));
    return {sinTheta * std::cos(phi), sinTheta * std::sin(phi), cosTheta};
}

struct Albedo {
    double white = 0.0;     // F = 1
    double weighted = 0.0;  // F = (1 - v·h)⁵
};

// Directional albedo of a single-scatter GGX lobe by the midpoint rule over visible normals (Dupuy and
// Benyoub 2023): the integrand D V cos / pdf is bounded, with a step where the light sinks below the horizon.
Albedo directionalAlbedo(double alpha, double cosView, int steps = 256) {
    const vec3 view = direction(cosView, 0.0);
    const vec3 stretched = glm::normalize(vec3(alpha * view.x, 0.0, view.z));
    const double smithView = std::sqrt(1.0 + alpha * alpha * (1.0 / (cosView * cosView) - 1.0));
    Albedo sum;
    for (int i = 0; i < steps; ++i) {
        const double z = (1.0 - (i + 0.5) / steps) * (1.0 + stretched.z) - stretched.z;
        for (int j = 0; j < steps; ++j) {
            vec3 half = direction(z, 2.0 * kPi * (j + 0.5) / steps) + stretched;
            half = glm::normalize(vec3(alpha * half.x, alpha * half.y, half.z));
            const double vDotH = glm::dot(view, half);
            const double cosLight = 2.0 * vDotH * half.z - view.z;
            if (cosLight <= 0.0) {
                continue;
            }
            // pdf of l = G1(v) D / (4 (n·v)), so D V cos / pdf = 4 V (n·l) (n·v) / G1(v); G1(v) = 2 / (1 +
            // smith).
            const double weight =
                2.0 * glsl::ggxVisibility(cosLight, cosView, alpha) * cosLight * cosView * (1.0 + smithView);
            sum.white += weight;
            sum.weighted += weight * std::pow(1.0 - vDotH, 5);
        }
    }
    return {sum.white / (steps * steps), sum.weighted / (steps * steps)};
}

TEST(Ggx, DistributionIntegratesToOneOverProjectedArea) {
    for (const double alpha : {1e-3, 0.01, 0.1, 0.5, 1.0}) {
        // Substitute t = tan θ / α, which keeps the peak resolved: ∫ D cos θ dω = 2π ∫ D cos⁴θ α² t dt.
        constexpr int kSteps = 200000;
        constexpr double kEnd = 1e3;
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            // Quadratic spacing: dense where the integrand is.
            const double s = (i + 0.5) / kSteps;
            const double t = kEnd * s * s;
            const double dt = 2.0 * kEnd * s / kSteps;
            const double cosTheta = 1.0 / std::sqrt(1.0 + alpha * alpha * t * t);
            const double distribution =
                glsl::ggxDistribution(vec3(0.0, 0.0, 1.0), direction(cosTheta, 0.3), alpha);
            sum += 2.0 * kPi * distribution * std::pow(cosTheta, 4) * alpha * alpha * t * dt;
        }
        EXPECT_NEAR(sum, 1.0, 2e-4) << "alpha " << alpha;
    }
}

TEST(Ggx, DistributionIsAccurateWhereTheTextbookFormIsNot) {
    // At θ = 1e-9 and alpha = 1e-4, D is within 1e-9 of its peak; 1 - cos² of a rounded cosine is not.
    const double alpha = 1e-4;
    const vec3 half(1e-9, 0.0, std::sqrt(1.0 - 1e-18));
    const double peak = 1.0 / (kPi * alpha * alpha);
    EXPECT_NEAR(glsl::ggxDistribution(vec3(0.0, 0.0, 1.0), half, alpha) / peak, 1.0, 1e-9);
}

TEST(Ggx, DirectionalAlbedoHasTheAnalyticValuesAtAlphaOne) {
    for (const double mu : {0.1, 0.3, 0.7, 1.0}) {
        EXPECT_NEAR(directionalAlbedo(1.0, mu).white, 1.0 - mu * std::log(1.0 + 1.0 / mu), 1e-3)
            << "mu " << mu;
    }
}

TEST(Ggx, DirectionalAlbedoAgreesWithTheTable) {
    std::ifstream table(GLINT_SOURCE_DIR "/../shared/reference/ggx_directional_albedo.csv");
    if (!table) {
        GTEST_SKIP() << "no table of reference values beside the repository";
    }
    // Columns: roughness, alpha, then E_mu<cosine> each, then the mean.
    std::string header;
    std::getline(table, header);
    std::vector<double> cosines;
    std::istringstream names(header);
    for (std::string name; std::getline(names, name, ',');) {
        if (name.starts_with("E_mu")) {
            cosines.push_back(std::stod(name.substr(4)));
        }
    }
    ASSERT_FALSE(cosines.empty()) << header;
    int rows = 0;
    for (std::string line; std::getline(table, line); ++rows) {
        std::istringstream cells(line);
        double roughness = 0.0;
        double alpha = 0.0;
        double expected = 0.0;
        char comma = 0;
        cells >> roughness >> comma >> alpha;
        for (const double mu : cosines) {
            cells >> comma >> expected;
            EXPECT_NEAR(directionalAlbedo(alpha, mu, 1024).white, expected, 3e-4)
                << "alpha " << alpha << ", mu " << mu;
        }
    }
    EXPECT_GT(rows, 0);
}

TEST(Ggx, VisibilityIsFiniteAndReciprocalDownToGrazing) {
    const double cosines[] = {1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0};
    for (const double alpha : {1e-4, 1e-2, 0.3, 1.0}) {
        for (const double a : cosines) {
            for (const double b : cosines) {
                const double visibility = glsl::ggxVisibility(a, b, alpha);
                EXPECT_TRUE(std::isfinite(visibility) && visibility > 0.0) << alpha << ' ' << a << ' ' << b;
                EXPECT_DOUBLE_EQ(visibility, glsl::ggxVisibility(b, a, alpha));
            }
        }
    }
}

TEST(Fresnel, SchlickHasItsEnds) {
    const vec3 f0(0.04, 0.5, 1.0);
    EXPECT_EQ(glsl::fresnelSchlick(f0, 1.0), f0);
    EXPECT_EQ(glsl::fresnelSchlick(f0, 0.0), vec3(1.0));
    EXPECT_EQ(glsl::fresnelSchlick(f0, 2.0), f0);
}

TEST(Fresnel, DirectionalAlbedoFitIsWithinItsStatedError) {
    for (const double roughness : {0.05, 0.2, 0.4, 0.6, 0.8, 1.0}) {
        for (const double mu : {0.05, 0.1, 0.25, 0.5, 0.75, 1.0}) {
            const Albedo albedo = directionalAlbedo(roughness * roughness, mu);
            const std::string where = "roughness " + std::to_string(roughness) + ", mu " + std::to_string(mu);
            EXPECT_NEAR(glsl::ggxDirectionalAlbedo(vec3(1.0), roughness, mu).x, albedo.white, 0.05) << where;
            EXPECT_NEAR(glsl::ggxDirectionalAlbedo(vec3(0.0), roughness, mu).x, albedo.weighted, 0.05)
                << where;
        }
    }
}

TEST(Fresnel, DirectionalAlbedoOfAMirrorIsSchlick) {
    for (const double mu : {0.05, 0.25, 0.5, 1.0}) {
        const vec3 f0(0.04, 0.5, 1.0);
        const vec3 difference = glsl::ggxDirectionalAlbedo(f0, 0.0, mu) - glsl::fresnelSchlick(f0, mu);
        EXPECT_LT(glm::length(difference), 1e-12) << "mu " << mu;
    }
}

}  // namespace

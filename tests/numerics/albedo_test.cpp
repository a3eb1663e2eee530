// Compares the fitted albedos with a quadrature that shares no code with the shaders or with the script that
// fits them.
#include "ggx_table.h"
#include "shaders_double.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kSteps = 64;

// The bounds that albedo.glsl and benchmarks/fit_directional_albedo.py state for fit - truth, if n·v is at
// least 1e-3.
constexpr double kUnder = 2e-4;
constexpr double kOver = 6e-3;
constexpr double kSheenOver = 1e-2;
constexpr double kSheenRelative = 2e-2;
constexpr double kSheenDark = 2e-5;

// The midpoint of step i in x, and dt. t = x - sin(2πx) / 2π flattens roots at both ends.
struct Node {
    explicit Node(int i) {
        const double angle = 2.0 * kPi * (i + 0.5) / kSteps;
        t = (angle - std::sin(angle)) / (2.0 * kPi);
        dt = (1.0 - std::cos(angle)) / kSteps;
    }
    double t = 0.0;
    double dt = 0.0;
};

// Half vectors by their angle θ to the normal: D is smooth in w; gives θ(w) and D sin θ dθ/dw.
struct Distribution {
    std::function<double(double theta)> warp;
    std::function<std::pair<double, double>(double w)> unwarp;
};

// ∫ D weight(v·h, n·l) dω over the half vectors that reflect the view to above the horizon. At the angle θ
// they have azimuths of cos φ >= (n·v) (1 - 2 cos²θ) / (2 sin θv sin θ cos θ), which follows from n·l = 2
// (v·h) cos θ - n·v.
double integrate(const Distribution& distribution, double nDotV,
                 const std::function<double(double vDotH, double nDotL)>& weight) {
    const double sineView = std::sqrt((1.0 - nDotV) * (1.0 + nDotV));
    const double elevation = std::atan2(nDotV, sineView);
    const std::array ends{0.0, 0.5 * elevation, 0.5 * (kPi - elevation)};
    double sum = 0.0;
    for (int piece = 0; piece < 2; ++piece) {
        const double low = distribution.warp(ends[piece]);
        const double width = distribution.warp(ends[piece + 1]) - low;
        for (int i = 0; i < kSteps; ++i) {
            const Node outer(i);
            const auto [theta, density] = distribution.unwarp(low + width * outer.t);
            const double sine = std::sin(theta);
            const double cosine = std::cos(theta);
            const double edge = -nDotV * std::cos(2.0 * theta) / (sineView * 2.0 * sine * cosine);
            const double azimuths = piece == 0 ? kPi : std::acos(std::clamp(edge, -1.0, 1.0));
            double ring = 0.0;
            for (int j = 0; j < kSteps; ++j) {
                const Node inner(j);
                const double vDotH = sineView * sine * std::cos(azimuths * inner.t) + nDotV * cosine;
                const double nDotL = 2.0 * vDotH * cosine - nDotV;
                if (nDotL > 0.0) {  // but for rounding at the edge
                    ring += weight(std::min(vDotH, 1.0), std::min(nDotL, 1.0)) * inner.dt;
                }
            }
            sum += ring * 2.0 * azimuths * density * width * outer.dt;
        }
    }
    return sum;
}

struct Albedo {
    double white = 0.0;     // F = 1
    double weighted = 0.0;  // F = (1 - v·h)⁵
};

// Trowbridge-Reitz with height-correlated Smith (Heitz 2014). D V (n·l) dω_l = D G (v·h) / (n·v) dω_h.
Albedo ggxTruth(double nDotV, double alpha) {
    const auto smith = [alpha](double cosine) {
        const double t = alpha * alpha * (1.0 - cosine) * (1.0 + cosine) / (cosine * cosine);
        return 0.5 * t / (std::sqrt(1.0 + t) + 1.0);
    };
    const Distribution distribution{
        [alpha](double theta) { return std::atan2(std::sin(theta), alpha * std::cos(theta)); },
        [alpha](double w) {
            const double theta = std::atan2(alpha * std::sin(w), std::cos(w));
            return std::pair(theta, std::sin(w) * std::cos(w) / (kPi * std::cos(theta)));
        }};
    const double view = smith(nDotV);
    const auto white = [&](double vDotH, double nDotL) {
        return vDotH / ((1.0 + view + smith(nDotL)) * nDotV);
    };
    return {integrate(distribution, nDotV, white),
            integrate(distribution, nDotV, [&](double vDotH, double nDotL) {
                return white(vDotH, nDotL) * std::pow(1.0 - vDotH, 5);
            })};
}

// Λ of KHR_materials_sheen, from the extension's text.
double sheenSmith(double cosine, double alpha) {
    const double t = (1.0 - alpha) * (1.0 - alpha);
    const auto exponent = [t](double x) {
        const double a = std::lerp(21.5473, 25.3245, t);
        const double b = std::lerp(3.82987, 3.32435, t);
        const double c = std::lerp(0.19823, 0.16801, t);
        const double d = std::lerp(-1.97760, -1.27393, t);
        const double e = std::lerp(-4.32054, -4.85967, t);
        return a / (1.0 + b * std::pow(x, c)) + d * x + e;
    };
    return cosine < 0.5 ? std::exp(exponent(cosine)) : std::exp(2.0 * exponent(0.5) - exponent(1.0 - cosine));
}

// Returns ∫ of the sheen lobe times share(n·l).
double sheenTruth(
    double nDotV, double alpha,
    const std::function<double(double nDotL)>& share = [](double) { return 1.0; }) {
    const double scale = std::sqrt(0.5 * alpha);  // the cosine over which D falls
    const Distribution distribution{[scale](double theta) { return -std::asinh(std::cos(theta) / scale); },
                                    [scale, alpha](double w) {
                                        const double cosine = std::clamp(scale * std::sinh(-w), 0.0, 1.0);
                                        const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
                                        return std::pair(std::acos(cosine),
                                                         (2.0 + 1.0 / alpha) * std::pow(sine, 1.0 / alpha) /
                                                             (2.0 * kPi) * scale * std::cosh(w));
                                    }};
    const double view = sheenSmith(nDotV, alpha);
    return integrate(distribution, nDotV, [&](double vDotH, double nDotL) {
        return share(nDotL) * vDotH / ((1.0 + view + sheenSmith(nDotL, alpha)) * nDotV);
    });
}

// Returns values that are evenly spaced, half of them in the logarithm and half in the value.
std::vector<double> spread(double low, int count) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) {
        const double x = (i + 0.5) / count;
        values.push_back(std::pow(low, 1.0 - x));
        values.push_back(low + (1.0 - low) * x);
    }
    values.push_back(low);
    values.push_back(1.0);
    return values;
}

std::string at(double alpha, double nDotV) {
    return "alpha " + std::to_string(alpha) + ", cosine " + std::to_string(nDotV);
}

TEST(GgxAlbedo, TruthHasTheAnalyticValuesAtAlphaOne) {
    for (const double nDotV : {1e-3, 0.01, 0.1, 0.3, 0.7, 1.0}) {
        EXPECT_NEAR(ggxTruth(nDotV, 1.0).white, 1.0 - nDotV * std::log(1.0 + 1.0 / nDotV), 2e-5)
            << "cosine " << nDotV;
    }
}

TEST(GgxAlbedo, TellsTooMuchRatherThanTooLittle) {
    for (const double alpha : spread(glsl::kMinAlpha, 17)) {
        for (const double nDotV : spread(1e-7, 17)) {
            const double under = nDotV < 1e-3 ? 3e-3 : kUnder;
            const double over = nDotV < 1e-3 ? 7e-3 : kOver;
            const Albedo truth = ggxTruth(nDotV, alpha);
            const glsl::vec2 fit = glsl::ggxAlbedo(nDotV, alpha);
            EXPECT_GE(1.0 - fit.x - truth.white, -under) << at(alpha, nDotV);
            EXPECT_LE(1.0 - fit.x - truth.white, over) << at(alpha, nDotV);
            EXPECT_GE(fit.y - truth.weighted, -under) << at(alpha, nDotV);
            EXPECT_LE(fit.y - truth.weighted, over) << at(alpha, nDotV);
        }
    }
}

TEST(GgxAlbedo, AgreesWithTheTable) {
    if (!std::filesystem::exists(glint::numerics::ggxTablePath())) {
        GTEST_SKIP() << glint::test::noModels(glint::numerics::ggxTablePath());
    }
    const std::vector<glint::numerics::GgxAlbedoEntry> table = glint::numerics::readGgxTable();
    EXPECT_FALSE(table.empty());
    for (const glint::numerics::GgxAlbedoEntry& entry : table) {
        const double excess = 1.0 - glsl::ggxAlbedo(entry.cosine, entry.alpha).x - entry.albedo;
        EXPECT_TRUE(excess >= -kUnder && excess <= kOver)
            << excess << " at " << at(entry.alpha, entry.cosine);
    }
}

TEST(GgxAlbedo, IsAShareOfTheLightAtAnyAngle) {
    std::vector<double> cosines = spread(1e-7, 100);
    cosines.push_back(0.0);
    for (const double alpha : spread(glsl::kMinAlpha, 100)) {
        for (const double nDotV : cosines) {
            const glsl::vec2 fit = glsl::ggxAlbedo(nDotV, alpha);
            EXPECT_TRUE(fit.x >= 0.0 && fit.y >= 0.0 && fit.x + fit.y <= 1.0) << at(alpha, nDotV);
        }
    }
}

TEST(GgxAlbedo, OfAMirrorIsSchlick) {
    for (const double nDotV : {0.05, 0.25, 0.5, 1.0}) {
        const glsl::vec2 fit = glsl::ggxAlbedo(nDotV, glsl::kMinAlpha);
        EXPECT_NEAR(fit.x, 0.0, 1e-5) << nDotV;
        EXPECT_NEAR(fit.y, std::pow(1.0 - nDotV, 5), 1e-3) << nDotV;
    }
}

TEST(GgxMeanAlbedo, CancelsTheIntegralOfTheFit) {
    constexpr int kCosines = 4000;
    const double range = std::log(1e8);
    for (const double alpha : spread(glsl::kMinAlpha, 40)) {
        // The midpoints are in log μ, because the loss of a smooth lobe lies about μ = alpha.
        glsl::vec2 integral(0.0);
        for (int i = 0; i < kCosines; ++i) {
            const double nDotV = std::exp(-range * (i + 0.5) / kCosines);
            integral += glsl::ggxAlbedo(nDotV, alpha) * (2.0 * nDotV * nDotV * range / kCosines);
        }
        const glsl::vec2 mean = glsl::ggxMeanAlbedo(alpha);
        // The share that a lobe with these reflectances leaves: 1 - f0 (E - y) - f90 y.
        for (const double f90 : {0.0, 0.3, 1.0}) {
            for (const double share : {0.0, 0.04, 0.5, 0.99, 1.0}) {
                const double f0 = f90 * share;
                const auto rest = [&](const glsl::vec2& lossBias) {
                    return (1.0 - f0) + f0 * lossBias.x - (f90 - f0) * lossBias.y;
                };
                const double ratio = rest(integral) / rest(mean);
                EXPECT_TRUE(ratio >= 0.98 && ratio <= 1.0 + 3e-4)
                    << ratio << " at alpha " << alpha << ", f0 " << f0 << ", f90 " << f90;
            }
        }
    }
}

TEST(SheenAlbedo, TellsTooMuchRatherThanTooLittle) {
    for (const double alpha : spread(glsl::kMinSheenAlpha, 17)) {
        for (const double nDotV : spread(1e-7, 17)) {
            const double truth = sheenTruth(nDotV, alpha);
            const double excess = glsl::sheenAlbedo(nDotV, alpha) - truth;
            EXPECT_GE(excess, -kUnder * std::max(1.0, truth)) << at(alpha, nDotV);
            EXPECT_LE(excess, kSheenOver * std::max(1.0, truth)) << at(alpha, nDotV);
            EXPECT_LE(excess, kSheenRelative * truth + kSheenDark) << at(alpha, nDotV);
        }
    }
}

TEST(SheenAlbedo, ExceedsOneOnlyWhereStated) {
    double smooth = 0.0;
    for (const double nDotV : spread(1e-4, 200)) {
        smooth = std::max(smooth, sheenTruth(nDotV, glsl::kMinSheenAlpha));
    }
    EXPECT_NEAR(smooth, 2.94, 0.01);
    for (const double alpha : spread(0.068, 20)) {
        for (const double nDotV : spread(6e-6, 20)) {
            EXPECT_LE(sheenTruth(nDotV, alpha), 1.0) << at(alpha, nDotV);
        }
    }
}

TEST(SheenAlbedo, DividesTheLobeIntoWhatMakesNoLight) {
    for (const double alpha : {glsl::kMinSheenAlpha, 0.01, 0.03, 0.068, 0.3, 1.0}) {
        for (const double nDotV : spread(1e-7, 40)) {
            const double view = glsl::sheenAlbedo(nDotV, alpha);
            const double reflected = sheenTruth(nDotV, alpha, [&](double nDotL) {
                return 1.0 / std::max({1.0, view, glsl::sheenAlbedo(nDotL, alpha)});
            });
            EXPECT_LE(reflected, 1.001) << at(alpha, nDotV);
        }
    }
}

}  // namespace

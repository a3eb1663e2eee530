#include <glint/measure/report.h>

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace glint::measure {
namespace {

// A world in which the squared error is noise / N plus the squares of what approximations leave out. Each
// round has another share of the noise.
constexpr double kNoise[] = {0.9, 1.1, 1.0, 0.8, 1.2, 1.0};
constexpr double kNoiseError = 0.02;

image::ImageErrors errorsOf(double squared) {
    image::ImageErrors errors;
    errors.relMse = errors.trimmed = squared;
    errors.rmse = std::sqrt(squared);
    return errors;
}

BenchPoint pointOf(compiler::Configuration configuration, double bias, double baseBias, ErrorMetric metric) {
    BenchPoint point;
    point.configuration = std::move(configuration);
    for (const double noise : kNoise) {
        point.errors.push_back(errorsOf(kNoiseError * noise + bias));
        const double base = valueOf(metric, errorsOf(kNoiseError * noise + baseBias));
        point.errorRatios.push_back(valueOf(metric, point.errors.back()) / base);
    }
    point.errorOfMean = errorsOf(kNoiseError / std::size(kNoise) + bias);
    return point;
}

Setting settingOf(std::string name, std::string base, std::string exact) {
    Setting setting;
    setting.name = std::move(name);
    setting.approximates = true;
    setting.base = std::move(base);
    setting.values = {setting.base, exact};
    setting.exact = std::move(exact);
    return setting;
}

// bounces: 0.05 of bias, texture-lod: 0.01; alpha changes nothing; 0.02 that only both take away.
std::vector<BenchPoint> world(ErrorMetric metric) {
    constexpr double kBias = 0.08;
    std::vector<BenchPoint> points{
        pointOf({}, kBias, kBias, metric), pointOf({{"texture-lod", "mip0"}}, kBias - 0.01, kBias, metric),
        pointOf({{"bounces", "unlimited"}}, kBias - 0.05, kBias, metric),
        pointOf({{"alpha", "stochastic"}}, kBias, kBias, metric),
        pointOf({{"alpha", "stochastic"}, {"bounces", "unlimited"}, {"texture-lod", "mip0"}}, 0.0, kBias,
                metric)};
    points.front().kind = PointKind::Default;
    return points;
}

TEST(ErrorParts, AreWhatEachExactValueTakesAway) {
    Setting skipped = settingOf("hit-lobes", "base", "all");
    skipped.values = {"base"};
    const std::vector<Setting> settings{settingOf("texture-lod", "cones", "mip0"),
                                        settingOf("bounces", "1", "unlimited"),
                                        settingOf("alpha", "opaque", "stochastic"), skipped};
    for (const ErrorMetric metric : {ErrorMetric::RelMse, ErrorMetric::Trimmed, ErrorMetric::Rmse}) {
        const ErrorParts parts = partsOfError(world(metric), settings, metric);
        ASSERT_EQ(parts.parts.size(), 3U);
        EXPECT_EQ(parts.parts[0].setting, "bounces");
        EXPECT_EQ(parts.parts[0].from, "1");
        EXPECT_EQ(parts.parts[0].to, "unlimited");
        EXPECT_EQ(parts.parts[0].removed.point, 2U);
        EXPECT_NEAR(parts.parts[0].removed.all.median, 0.5, 0.005);
        EXPECT_NEAR(parts.parts[0].removed.bias, 0.5, 1e-9);
        EXPECT_NEAR(parts.parts[0].removed.noise, 0.0, 1e-9);
        EXPECT_NEAR(parts.parts[1].removed.bias, 0.1, 1e-9);
        EXPECT_NEAR(parts.parts[2].removed.bias, 0.0, 1e-9);
        EXPECT_NEAR(parts.noise, 0.2, 1e-9);
        EXPECT_NEAR(parts.rest, 0.2, 1e-9);
        ASSERT_TRUE(parts.exact);
        EXPECT_EQ(parts.exact->point, 4U);
        EXPECT_NEAR(parts.exact->all.median, 0.8, 0.01);
        EXPECT_NEAR(parts.exact->bias, 0.8, 1e-9);
    }
}

// An exact value may add noise: rays in the place of a mean.
TEST(ErrorParts, TellBiasFromNoise) {
    std::vector<BenchPoint> points = world(ErrorMetric::Trimmed);
    BenchPoint& bounces = points[2];
    for (std::size_t i = 0; i < bounces.errors.size(); ++i) {
        bounces.errors[i] = errorsOf(5.0 * kNoiseError * kNoise[i] + 0.03);
        bounces.errorRatios[i] = bounces.errors[i].trimmed / points[0].errors[i].trimmed;
    }
    bounces.errorOfMean = errorsOf(5.0 * kNoiseError / std::size(kNoise) + 0.03);
    const std::vector<Setting> settings{settingOf("bounces", "1", "unlimited")};
    const RemovedError removed = partsOfError(points, settings, ErrorMetric::Trimmed).parts[0].removed;
    EXPECT_NEAR(removed.bias, 0.5, 1e-9);
    EXPECT_NEAR(removed.noise, -0.8, 1e-9);
    EXPECT_LT(removed.all.median, 0.0);
}

TEST(ErrorParts, OfOneRoundSayNothingOfNoise) {
    std::vector<BenchPoint> points = world(ErrorMetric::Trimmed);
    points.resize(1);
    points[0].errors.resize(1);
    const ErrorParts parts = partsOfError(points, {}, ErrorMetric::Trimmed);
    EXPECT_EQ(parts.noise, 0.0);
    EXPECT_FALSE(parts.exact);
    EXPECT_TRUE(parts.parts.empty());
    EXPECT_EQ(parts.rest, 1.0);
}

}  // namespace
}  // namespace glint::measure

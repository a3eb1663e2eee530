// Tests the fit behind glint bench --calibrate: it must find the constants of planted devices.
#include <glint/measure/device_file.h>
#include <glint/measure/statistics.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace glint::measure {
namespace {

using Rows = std::vector<std::vector<double>>;

TEST(LeastSquares, SolvesWhatHasASolution) {
    const Rows rows{{1.0, 0.0}, {1.0, 1.0}, {1.0, 2.0}, {1.0, 5.0}};
    const std::vector<double> values{3.0, 5.0, 7.0, 13.0};
    const auto x = nonNegativeLeastSquares(rows, values, 2);
    ASSERT_TRUE(x);
    EXPECT_NEAR((*x)[0], 3.0, 1e-12);
    EXPECT_NEAR((*x)[1], 2.0, 1e-12);
}

TEST(LeastSquares, LeavesOutWhatWouldBeNegative) {
    // The values fall, so the slope would be below zero, and the mean is best.
    const Rows rows{{1.0, 0.0}, {1.0, 1.0}, {1.0, 2.0}};
    const std::vector<double> values{3.0, 2.0, 1.0};
    const auto x = nonNegativeLeastSquares(rows, values, 2);
    ASSERT_TRUE(x);
    EXPECT_NEAR((*x)[0], 2.0, 1e-12);
    EXPECT_EQ((*x)[1], 0.0);
}

TEST(LeastSquares, KeepsTheConditionsOfAMinimum) {
    std::mt19937 random(11);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same problems in every run
    std::normal_distribution<double> normal;
    for (int problem = 0; problem < 50; ++problem) {
        constexpr std::size_t kUnknowns = 6;
        Rows rows(15, std::vector<double>(kUnknowns));
        std::vector<double> values(rows.size());
        for (std::size_t r = 0; r < rows.size(); ++r) {
            for (double& entry : rows[r]) {
                entry = normal(random);
            }
            values[r] = normal(random);
        }
        const auto x = nonNegativeLeastSquares(rows, values, kUnknowns);
        ASSERT_TRUE(x);
        // The gradient is 0 where x is above 0, and not below 0 elsewhere (Karush, Kuhn, Tucker).
        for (std::size_t i = 0; i < kUnknowns; ++i) {
            double gradient = 0.0;
            for (std::size_t r = 0; r < rows.size(); ++r) {
                double residual = -values[r];
                for (std::size_t j = 0; j < kUnknowns; ++j) {
                    residual += rows[r][j] * (*x)[j];
                }
                gradient += rows[r][i] * residual;
            }
            EXPECT_GE((*x)[i], 0.0);
            EXPECT_GE(gradient, -1e-9);
            EXPECT_NEAR(gradient * (*x)[i], 0.0, 1e-8);
        }
    }
}

TEST(LeastSquares, BearsColumnsThatSayNothingNew) {
    const Rows rows{{1.0, 2.0, 0.0}, {2.0, 4.0, 0.0}, {3.0, 6.0, 0.0}};
    const std::vector<double> values{2.0, 4.0, 6.0};
    const auto x = nonNegativeLeastSquares(rows, values, 3);
    ASSERT_TRUE(x);
    EXPECT_NEAR((*x)[0] + 2.0 * (*x)[1], 2.0, 1e-9);
    EXPECT_EQ((*x)[2], 0.0);
    EXPECT_FALSE(nonNegativeLeastSquares({}, {}, 3));
    EXPECT_FALSE(nonNegativeLeastSquares(rows, values, measure::kMostUnknowns + 1));
}

measure::CalibrationPoint makePoint(std::uint32_t cases, const std::string& cost,
                                    const std::string& coherence, double rays) {
    measure::CalibrationPoint point;
    point.cases = cases;
    point.cost = cost;
    point.coherence = coherence;
    point.rays = rays;
    point.hitShare = 0.9;
    point.coherentShare = coherence == "coherent" ? 0.9 : 0.05;
    const double base = cost == "cheap" ? 600.0 : 2000.0;
    for (std::uint32_t i = 0; i < cases; ++i) {
        point.work.push_back({1.0 / cases, base + 150.0 * (i % 5), i % 4 * 1.0});
    }
    return point;
}

std::vector<measure::CalibrationPoint> makePoints() {
    std::vector<measure::CalibrationPoint> points;
    for (const std::uint32_t cases : {1U, 4U, 16U, 64U, 256U}) {
        for (const char* cost : {"cheap", "expensive"}) {
            for (const char* coherence : {"coherent", "incoherent"}) {
                for (const double rays : {1e6, 8e6, 3.2e7}) {
                    points.push_back(makePoint(cases, cost, coherence, rays));
                }
            }
        }
    }
    return points;
}

// The constants are in the order of CostTerm. Terms that a strategy lacks have no effect.
const std::vector<compiler::StrategyCosts> kPlanted{
    {"uber", {0.02, 0.0, 0.4, 0.3, 0.0, 0.15, 0.1, 0.001}},
    {"sorted-uber", {0.08, 0.001, 0.9, 0.3, 0.02, 0.16, 0.0, 0.002}},
    {"visibility", {0.06, 0.004, 0.9, 0.25, 0.02, 0.12, 0.0, 0.0}},
    {"hit-shaders", {0.03, 0.0, 0.7, 0.4, 0.0, 0.2, 0.12, 0.0}},
};
constexpr double kSubgroup = 32.0;

// Measures the planted device, with each time off by up to `noise` of itself.
void measure(std::vector<measure::CalibrationPoint>& points, double noise) {
    std::mt19937 random(3);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same noise in every run
    std::uniform_real_distribution<double> uniform(-noise, noise);
    for (measure::CalibrationPoint& point : points) {
        for (const compiler::StrategyCosts& costs : kPlanted) {
            const double ms = estimatedMs(roundOf(point), costs, kSubgroup) * (1.0 + uniform(random));
            point.times.push_back({costs.strategy, ms});
        }
    }
}

TEST(StrategyFit, FindsThePlantedConstants) {
    std::vector<measure::CalibrationPoint> points = makePoints();
    measure(points, 0.0);
    const measure::DeviceFit fit = fitStrategies(points, kSubgroup);
    EXPECT_TRUE(fit.omitted.empty());
    ASSERT_EQ(fit.strategies.size(), kPlanted.size());
    for (std::size_t i = 0; i < kPlanted.size(); ++i) {
        EXPECT_EQ(fit.strategies[i].strategy, kPlanted[i].strategy);
        for (const compiler::CostTermInfo& info : compiler::costTerms()) {
            const auto term = static_cast<std::size_t>(info.term);
            EXPECT_NEAR(fit.strategies[i].constants[term], kPlanted[i].constants[term],
                        1e-6 * kPlanted[i].constants[term] + 1e-12)
                << kPlanted[i].strategy << " " << info.name;
        }
        EXPECT_EQ(fit.quality.strategies[i].points, points.size());
        EXPECT_LT(fit.quality.strategies[i].worstError, 1e-6);
    }
    EXPECT_TRUE(fit.quality.held);
    EXPECT_EQ(fit.quality.regret.points, points.size());
    EXPECT_LT(fit.quality.regret.worst, 1e-6);
    EXPECT_EQ(fit.quality.regret.withinFivePercent, 1.0);
}

TEST(StrategyFit, BearsNoise) {
    std::vector<measure::CalibrationPoint> points = makePoints();
    measure(points, 0.03);
    const measure::DeviceFit fit = fitStrategies(points, kSubgroup);
    ASSERT_EQ(fit.quality.strategies.size(), kPlanted.size());
    for (const measure::StrategyQuality& quality : fit.quality.strategies) {
        EXPECT_GT(quality.medianError, 0.001) << quality.strategy;
        EXPECT_LT(quality.medianError, 0.05) << quality.strategy;
        EXPECT_FALSE(quality.worstPoint.empty());
    }
    EXPECT_LT(fit.quality.regret.median, 0.03);
    EXPECT_GE(fit.quality.regret.worst, fit.quality.regret.median);
}

TEST(StrategyFit, ErrorsAreOfPointsThatTheFitHasNotSeen) {
    // No model can follow this group, so the constants of the others must not depend on it.
    std::vector<measure::CalibrationPoint> points = makePoints();
    measure(points, 0.0);
    for (measure::CalibrationPoint& point : points) {
        if (point.cases == 16 && point.cost == "cheap" && point.coherence == "coherent") {
            for (measure::StrategyTime& time : point.times) {
                time.ms *= time.strategy == "uber" ? 3.0 : 1.0;
            }
        }
    }
    const measure::DeviceFit fit = fitStrategies(points, kSubgroup);
    // The estimate is what the planted constants give: a third of the measured time.
    EXPECT_NEAR(fit.quality.strategies.front().worstError, 2.0 / 3.0, 1e-4);
    EXPECT_NE(fit.quality.strategies.front().worstPoint.find("16 cases, cheap, coherent"), std::string::npos);
    EXPECT_GT(fit.quality.regret.worst, 0.5);
    EXPECT_NE(fit.quality.regret.worstPoint.find("uber taken"), std::string::npos);
}

TEST(StrategyFit, LeavesOutWhatWasNotMeasured) {
    std::vector<measure::CalibrationPoint> points = makePoints();
    measure(points, 0.0);
    for (measure::CalibrationPoint& point : points) {
        std::erase_if(point.times, [&](const measure::StrategyTime& time) {
            return time.strategy == "hit-shaders" || (time.strategy == "visibility" && point.cases != 4);
        });
    }
    // There are twelve points, but with one number of cases: launches and cases can't be told apart, only
    // their sum is known.
    const measure::DeviceFit fit = fitStrategies(points, kSubgroup);
    ASSERT_EQ(fit.strategies.size(), 3U);
    EXPECT_EQ(fit.strategies[2].strategy, "visibility");
    const measure::CalibrationPoint known = points[12];
    ASSERT_EQ(known.cases, 4U);
    EXPECT_NEAR(estimatedMs(roundOf(known), fit.strategies[2], kSubgroup),
                estimatedMs(roundOf(known), kPlanted[2], kSubgroup), 1e-6);
    ASSERT_EQ(fit.omitted.size(), 1U);
    EXPECT_EQ(fit.omitted[0], "hit-shaders was not measured");
}

TEST(StrategyFit, SaysWhatItCanNotUse) {
    EXPECT_TRUE(fitStrategies({}, kSubgroup).strategies.empty());
    std::vector<measure::CalibrationPoint> points = makePoints();
    points.resize(4);
    measure(points, 0.0);
    points[0].rays = std::numeric_limits<double>::quiet_NaN();
    points[1].times[0].ms = 0.0;
    points[2].work.clear();
    points[3].times.push_back({"magic", 1.0});
    const measure::DeviceFit fit = fitStrategies(points, kSubgroup);
    EXPECT_TRUE(fit.strategies.empty());
    std::string all;
    for (const std::string& sentence : fit.omitted) {
        all += sentence + "\n";
    }
    for (const char* const expected :
         {"has no rays", "the time of uber at the point 1 case, cheap, coherent, 8000000 rays",
          "has no cases", "the time of magic", "uber has 1 usable points, and 7 terms to find"}) {
        EXPECT_NE(all.find(expected), std::string::npos) << expected << "\n" << all;
    }
}

}  // namespace
}  // namespace glint::measure

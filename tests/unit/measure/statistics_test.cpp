#include <glint/measure/statistics.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace glint::measure {
namespace {

std::vector<double> upTo(int count) {
    std::vector<double> values(static_cast<std::size_t>(count));
    std::iota(values.begin(), values.end(), 1.0);
    return values;
}

TEST(Interval, IsOfOrderStatistics) {
    // The numbers left out at each end are those of the sign test's table: 5 of 20, 1 of 10, 0 of 6 and 8, 1
    // of 9, 3 of 15.
    struct Row {
        int count;
        double low;
    };
    for (const Row row : {Row{6, 1}, {8, 1}, {9, 2}, {10, 2}, {15, 4}, {20, 6}, {101, 41}}) {
        const measure::Interval interval = intervalOf(upTo(row.count));
        EXPECT_EQ(interval.low, row.low) << row.count;
        EXPECT_EQ(interval.high, row.count + 1 - row.low) << row.count;
        EXPECT_EQ(interval.median, 0.5 * (row.count + 1)) << row.count;
    }
}

TEST(Interval, IsTheRangeOfFewValues) {
    const measure::Interval interval = intervalOf(std::vector<double>{3, 1, 2});
    EXPECT_EQ(interval.low, 1);
    EXPECT_EQ(interval.high, 3);
    EXPECT_EQ(interval.median, 2);
    EXPECT_EQ(interval.q1, 1.5);
    EXPECT_EQ(interval.q3, 2.5);
    const measure::Interval one = intervalOf(std::vector<double>{7});
    EXPECT_EQ(one.low, 7);
    EXPECT_EQ(one.high, 7);
    EXPECT_EQ(one.q3, 7);
}

// The distribution is skewed, so its mean is far from its median.
TEST(Interval, HoldsTheMedianAsOftenAsItSays) {
    std::mt19937_64 random(5);
    const double truth = std::log(2.0);
    for (const int count : {6, 11, 36}) {
        constexpr int kTrials = 4000;
        int held = 0;
        for (int trial = 0; trial < kTrials; ++trial) {
            std::vector<double> values;
            for (int i = 0; i < count; ++i) {
                const double uniform = (static_cast<double>(random() >> 11U) + 0.5) * 0x1p-53;
                values.push_back(-std::log(uniform));
            }
            const measure::Interval interval = intervalOf(values);
            held += interval.low <= truth && truth <= interval.high ? 1 : 0;
        }
        // The bound is four standard errors below what is promised.
        EXPECT_GT(held, kTrials * (0.95 - 4.0 * std::sqrt(0.95 * 0.05 / kTrials))) << count;
    }
}

TEST(MeanInterval, IsThatOfStudent) {
    // The two-sided 95 % quantiles of t are 2.776 for 4 degrees, 2.228 for 10, 12.706 for 1.
    const std::vector<double> five{1, 2, 3, 4, 5};
    const measure::MeanInterval interval = meanOf(five);
    EXPECT_EQ(interval.mean, 3);
    EXPECT_NEAR(interval.high - 3, 2.776 * std::sqrt(2.5 / 5), 2e-3);
    EXPECT_NEAR(3 - interval.low, 2.776 * std::sqrt(2.5 / 5), 2e-3);
    const measure::MeanInterval eleven = meanOf(upTo(11));
    EXPECT_NEAR(eleven.high - 6, 2.228 * std::sqrt(11.0 / 11), 1e-3);
    const measure::MeanInterval two = meanOf(std::vector<double>{0, 2});
    EXPECT_NEAR(two.high - 1, 12.706, 1e-3);
    const measure::MeanInterval one = meanOf(std::vector<double>{4});
    EXPECT_EQ(one.low, 4);
    EXPECT_EQ(one.high, 4);
}

TEST(Ties, AreIntervalsThatHoldNoChange) {
    EXPECT_TRUE(isTie({1.1, 1.0, 1.2}));
    EXPECT_FALSE(isTie({1.1, 1.01, 1.2}));
    EXPECT_TRUE(isTie({0.1, -0.1, 0.2}, 0.0));
    EXPECT_TRUE(overlap({1, 0, 2}, {3, 2, 4}));
    EXPECT_FALSE(overlap({1, 0, 2}, {3, 2.5, 4}));
}

}  // namespace
}  // namespace glint::measure

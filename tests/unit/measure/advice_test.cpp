#include <glint/measure/sweep.h>

#include <gtest/gtest.h>

#include <vector>

namespace glint::measure {
namespace {

measure::Offer offer(double time, double error, double spread = 0.01) {
    const auto around = [spread](double value) {
        return measure::Interval{value, value * (1.0 - spread), value * (1.0 + spread), value, value};
    };
    return {around(time), around(error)};
}

const std::vector<measure::Offer> kOffers{offer(10, 0.1), offer(5, 0.4), offer(20, 0.01), offer(9, 0.1005)};

TEST(Advice, TakesTheLeastErrorWithinABudget) {
    EXPECT_EQ(advise(kOffers, {15.0, {}}), 3U);  // as exact as the first, and faster
    EXPECT_EQ(advise(kOffers, {8.0, {}}), 1U);
    EXPECT_EQ(advise(kOffers, {100.0, {}}), 2U);
}

TEST(Advice, TakesTheLeastTimeWithinAnError) {
    EXPECT_EQ(advise(kOffers, {{}, 0.2}), 3U);
    EXPECT_EQ(advise(kOffers, {{}, 1.0}), 1U);
    EXPECT_EQ(advise(kOffers, {{}, 0.02}), 2U);
}

TEST(Advice, IsSilentWhereNothingIsSurelyWithin) {
    EXPECT_EQ(advise(kOffers, {4.0, {}}), std::nullopt);
    // The median is within the budget, but the interval is not.
    EXPECT_EQ(advise(kOffers, {5.01, {}}), std::nullopt);
    EXPECT_EQ(advise(kOffers, {8.0, 0.3}), std::nullopt);
    EXPECT_EQ(advise({}, {8.0, {}}), std::nullopt);
}

TEST(Advice, HoldsBothDemands) {
    EXPECT_EQ(advise(kOffers, {15.0, 0.3}), 3U);
    EXPECT_EQ(advise(kOffers, {30.0, 0.05}), 2U);
}

}  // namespace
}  // namespace glint::measure

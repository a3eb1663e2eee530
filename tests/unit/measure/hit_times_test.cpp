// Tests which passes count when strategies are compared.
#include <glint/measure/hit_times.h>

#include <gtest/gtest.h>

#include <vector>

namespace glint::measure {
namespace {

TEST(HitTimes, CountsWhatStrategiesDifferIn) {
    const std::vector<PassTime> passes{
        {HitPart::None, 100.0}, {HitPart::Dispatch, 1.0}, {HitPart::Trace, 2.0},   {HitPart::Order, 3.0},
        {HitPart::Order, 4.0},  {HitPart::Shade, 5.0},    {HitPart::Shadow, 6.0},  {HitPart::None, 200.0},
        {HitPart::Trace, 20.0}, {HitPart::Shade, 50.0},   {HitPart::Shadow, 60.0}, {HitPart::None, 400.0},
    };
    const HitTimes times = hitTimesOf(passes);
    EXPECT_EQ(times.dispatch, 1.0);
    EXPECT_EQ(times.trace, 22.0);
    EXPECT_EQ(times.order, 7.0);
    EXPECT_EQ(times.shade, 55.0);
    EXPECT_EQ(times.shadow, 66.0);
    EXPECT_EQ(times.sum(), 151.0);
    EXPECT_EQ(hitTimesOf({}).sum(), 0.0);
}

TEST(HitTimes, Averages) {
    HitTimes times{1.0, 2.0, 3.0, 4.0, 5.0};
    times += HitTimes{3.0, 2.0, 1.0, 0.0, 1.0};
    times /= 2.0;
    EXPECT_EQ(times.sum(), 11.0);
    EXPECT_EQ(times.dispatch, 2.0);
    EXPECT_EQ(times.shadow, 3.0);
}

}  // namespace
}  // namespace glint::measure

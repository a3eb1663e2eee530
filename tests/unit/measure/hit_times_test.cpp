// Tests which passes count when strategies are compared.
#include <glint/measure/point.h>

#include <gtest/gtest.h>

#include <vector>

namespace glint::measure {
namespace {

TEST(HitTimes, CountsWhatStrategiesDifferIn) {
    // Names are for people, so they decide nothing.
    const std::vector<PassTiming> passes{
        {"shade", 100.0, Pass::FirstShade},
        {"a", 1.0, Pass::RayDispatch},
        {"trace", 2.0, Pass::Trace},
        {"b", 1.0, Pass::Count},
        {"c", 2.0, Pass::Offset},
        {"d", 4.0, Pass::Copy},
        {"e", 5.0, Pass::Shade},
        {"f", 6.0, Pass::Shadow},
        {"copy", 200.0, Pass::Compose},
        {"uber", 20.0, Pass::Trace},
        {"g", 25.0, Pass::ShadeCase, 3},
        {"h", 10.0, Pass::Shade},
        {"i", 10.0, Pass::Shade},
        {"j", 5.0, Pass::Shade},
        {"k", 60.0, Pass::ShadowDispatch},
        {"trace", 400.0, Pass::CheckOrder},
    };
    const measure::HitTimes times = hitTimesOf(passes);
    EXPECT_EQ(times.dispatch, 1.0);
    EXPECT_EQ(times.trace, 22.0);
    EXPECT_EQ(times.order, 7.0);
    EXPECT_EQ(times.shade, 55.0);
    EXPECT_EQ(times.shadow, 66.0);
    EXPECT_EQ(times.sum(), 151.0);
    EXPECT_EQ(hitTimesOf({}).sum(), 0.0);
}

TEST(HitTimes, Averages) {
    measure::HitTimes times{1.0, 2.0, 3.0, 4.0, 5.0};
    times += measure::HitTimes{3.0, 2.0, 1.0, 0.0, 1.0};
    times /= 2.0;
    EXPECT_EQ(times.sum(), 11.0);
    EXPECT_EQ(times.dispatch, 2.0);
    EXPECT_EQ(times.shadow, 3.0);
}

}  // namespace
}  // namespace glint::measure

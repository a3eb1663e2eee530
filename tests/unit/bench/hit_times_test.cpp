// Tests which passes count when strategies are compared.
#include "bench/hit_times.h"

#include <gtest/gtest.h>

#include <vector>

namespace glint::bench {
namespace {

TEST(HitTimes, CountsWhatStrategiesDifferIn) {
    const std::vector<PassTime> passes{
        {"gbuffer", 100.0},
        {"lighting", 200.0},
        {"reflection rays", 400.0},
        {"ray dispatch", 1.0},
        {"trace", 2.0},
        {"count", 3.0},
        {"offset", 4.0},
        {"copy", 5.0},
        {"check order", 800.0},
        {"shade miss", 6.0},
        {"shade 0_Normals", 7.0},
        {"shadow dispatch", 8.0},
        {"shadow", 9.0},
        {"refraction walk", 1e3},
        {"refraction rays", 2e3},
        {"ray dispatch", 10.0},
        {"trace", 20.0},
        {"one pass order", 30.0},
        {"shade 0_Normals", 40},
        {"compose", 3e3},
        {"anything", 4e3},
    };
    const HitTimes times = hitTimesOf(passes);
    EXPECT_EQ(times.dispatch, 11.0);
    EXPECT_EQ(times.trace, 22.0);
    EXPECT_EQ(times.order, 42.0);
    EXPECT_EQ(times.shade, 53.0);
    EXPECT_EQ(times.shadow, 17.0);
    EXPECT_EQ(times.sum(), 145.0);
}

TEST(HitTimes, TakesStrategiesThatOrderNothing) {
    for (const char* const name : {"uber", "hit shaders"}) {
        const HitTimes times = hitTimesOf(
            std::vector<PassTime>{{"lighting", 9.0}, {"ray dispatch", 1.0}, {name, 2.0}, {"compose", 9.0}});
        EXPECT_EQ(times.shade, 2.0) << name;
        EXPECT_EQ(times.sum(), 3.0) << name;
    }
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
}  // namespace glint::bench

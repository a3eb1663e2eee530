// Tests what a calibration concludes from its measurements.
#include "base/fields.h"
#include "measure/calibration_measure.h"

#include <glint/measure/calibration.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace glint::measure {
namespace {

using Names = std::vector<std::string>;

measure::StrategyMeasure measured(const std::string& strategy, double ratio, std::uint64_t differing = 0) {
    measure::StrategyMeasure measure;
    measure.strategy = strategy;
    for (const double noise : {0.99, 1.0, 1.01, 1.0, 0.99, 1.01}) {
        measure.times.push_back(8.0 * ratio * noise);
        measure.ratios.push_back(ratio * (strategy == "uber" ? 1.0 : noise));
    }
    measure.difference = {1.0, differing, 100000};
    return measure;
}

measure::CalibrationEntry entryOf(std::vector<measure::StrategyMeasure> strategies) {
    measure::CalibrationEntry entry;
    entry.strategies = std::move(strategies);
    settleEntry(entry);
    return entry;
}

TEST(CalibrationEntry, NamesTheFastest) {
    EXPECT_EQ(entryOf({measured("uber", 1.0), measured("visibility", 0.5)}).fastest, Names{"visibility"});
    EXPECT_EQ(entryOf({measured("uber", 1.0), measured("visibility", 1.5)}).fastest, Names{"uber"});
    const Names tie{"visibility", "sorted-uber"};
    EXPECT_EQ(
        entryOf({measured("uber", 1.0), measured("visibility", 0.5), measured("sorted-uber", 0.505)}).fastest,
        tie);
}

TEST(CalibrationEntry, DoesNotCountWrongPictures) {
    // 1 in 1000 is accepted, because a ray that grazes an edge may differ; more is wrong.
    const measure::CalibrationEntry right =
        entryOf({measured("uber", 1.0), measured("visibility", 0.5, 100)});
    EXPECT_EQ(right.fastest, Names{"visibility"});
    const measure::CalibrationEntry wrong =
        entryOf({measured("uber", 1.0), measured("visibility", 0.5, 101)});
    EXPECT_EQ(wrong.fastest, Names{"uber"});
    ASSERT_EQ(wrong.point.times.size(), 1U);
    EXPECT_EQ(wrong.point.times[0].strategy, "uber");
    EXPECT_NEAR(wrong.point.times[0].ms, 8.0, 1e-9);
}

TEST(CalibrationEntry, TakesStrategiesThatDidNotRun) {
    measure::StrategyMeasure skipped;
    skipped.strategy = "hit-shaders";
    skipped.skipped = "out of memory";
    measure::CalibrationReport report;
    report.entries = {entryOf({measured("uber", 1.0), skipped}), entryOf({skipped})};
    EXPECT_EQ(report.entries[0].fastest, Names{"uber"});
    EXPECT_TRUE(report.entries[1].fastest.empty());
    EXPECT_EQ(base::jsonOf(report).at("points")[0].at("strategies")[1].at("skipped"), "out of memory");
}

TEST(CalibrationPicture, HasAsManyPixelsAsRays) {
    for (const std::uint64_t rays : {1024ULL, 16000ULL, 1000000ULL, 32000000ULL, 64000000ULL}) {
        std::uint32_t width = 0;
        std::uint32_t height = 0;
        sizeFor(rays, width, height);
        EXPECT_EQ(width, 2 * height);
        EXPECT_EQ(height % 8, 0U);
        EXPECT_LE(width, 16384U);
        // The height is rounded to half a tile.
        const double exact = static_cast<double>(rays);
        EXPECT_NEAR(static_cast<double>(width) * height, exact, exact * 0.19);
    }
}

}  // namespace
}  // namespace glint::measure

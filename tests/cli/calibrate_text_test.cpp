// The table that glint bench --calibrate prints.
#include "cli/bench/bench.h"

#include <gtest/gtest.h>

#include <string>

namespace glint {
namespace {

TEST(CalibrationText, HasAColumnForUberAndADashForWhatDidNotRun) {
    measure::StrategyMeasure uber;
    uber.strategy = "uber";
    uber.times = {8.0, 8.0, 8.0};
    uber.ratios = {1.0, 1.0, 1.0};
    measure::StrategyMeasure skipped;
    skipped.strategy = "hit-shaders";
    skipped.skipped = "out of memory";
    measure::CalibrationEntry entry;
    entry.strategies = {uber, skipped};
    measure::settleEntry(entry);
    measure::CalibrationReport report;
    report.entries = {entry};
    const std::string text = cli::toText(report);
    EXPECT_NE(text.find("| uber, ms |"), std::string::npos) << text;
    EXPECT_NE(text.find("| 8.000"), std::string::npos) << text;
    EXPECT_NE(text.find("| -"), std::string::npos) << text;
}

}  // namespace
}  // namespace glint

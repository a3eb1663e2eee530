// Says which strategy is fastest for a scene and a device, and which measurements explain it.
#pragma once

#include "cli/bench_point.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Times in milliseconds for a picture; they are medians.
struct StrategyRow {
    std::string strategy;
    std::size_t point = 0;  // index
    bench::Interval ratio;  // of time, to the default
    // The time of the passes in which strategies differ, from the list of rays to their shaded hits.
    bench::Interval hits;
    bench::Interval hitRatio;  // of those, to the default's in the same round
    double traceMs = 0.0;      // of hits that are traced by a pass of their own
    double orderMs = 0.0;
    double shadeMs = 0.0;    // the rest of `hits`; for uber and hit-shaders with their tracing
    double commonMs = 0.0;   // what every strategy does alike
    std::uint32_t rays = 0;  // of the last sample
};

struct StrategyReport {
    std::vector<StrategyRow> rows;     // those that were measured, of the default's other settings
    std::vector<std::string> fastest;  // several: a tie
    // Counts of hits in the last sample of a strategy that counts them by case; zeros if no such strategy was
    // measured.
    std::uint32_t cases = 0;
    std::uint32_t filledCases = 0;  // that any hit has
    double largestShare = 0.0;      // of hits in the case that has most
    // The average number of cases among 32 hits in random order. An uber shader runs at most that many one
    // after another in a subgroup of that size.
    double casesInWave = 0.0;
    std::vector<std::string> why;  // sentences
};

// `base` is the strategy of the default, which is the first of `points`.
StrategyReport compareStrategies(std::span<const BenchPoint> points, const std::string& base);

}  // namespace glint

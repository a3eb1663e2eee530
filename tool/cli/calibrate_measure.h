// Times of the strategies at one point: one scene, one number of rays.
#pragma once

#include "cli/calibrate_group.h"
#include "cli/calibrate_report.h"

#include <cstdint>
#include <string>

namespace glint {

// Pixels, 2 : 1 and whole tiles of the passes: each sends a ray.
void sizeFor(std::uint64_t rays, std::uint32_t& width, std::uint32_t& height);

struct PointOptions {
    std::uint64_t rays = 0;
    std::uint32_t rounds = 1;
    std::uint32_t seed = 1;
    std::string picture{};  // .png of uber's; empty: none
};

// Every strategy renders once, for its pipelines to be ready and its picture to be compared with that of
// uber; then in each round, in random order. Before a round, and before each strategy, a GPU renders for a
// while, as its clocks fall where it waits. A strategy that can't run is left out with its reason; where that
// is uber, so are all others. Errors: of the device once it has begun, of the picture's file.
Result<CalibrationEntry> measurePoint(Context& context, CalibrationGroup& group,
                                      const CalibrationScene& scene, const BenchArguments& arguments,
                                      const PointOptions& options);

}  // namespace glint

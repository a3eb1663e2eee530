// Measures the strategies at one point: one scene, and one number of rays.
#pragma once

#include "measure/calibration_group.h"

#include <glint/measure/calibration_report.h>

#include <cstdint>
#include <string>

namespace glint::measure {

// Chooses a picture of 2 : 1 in whole tiles of the passes, in which each pixel sends a ray.
void sizeFor(std::uint64_t rays, std::uint32_t& width, std::uint32_t& height);

struct PointOptions {
    std::uint64_t rays = 0;
    std::uint32_t rounds = 1;
    std::uint32_t seed = 1;
    std::string picture{};  // .png of uber's; empty: none
};

// Every strategy first renders once, so that its pipelines are ready and its picture can be compared with
// that of uber. Then it renders in each round, in random order. Before a round, and before each strategy, a
// GPU renders for a while, because its clocks fall while it waits. A strategy that can't run is left out with
// its reason; if that is uber, all others are left out too. Errors: of the device once measuring has begun,
// and of the picture's file.
Result<CalibrationEntry> measurePoint(Context& context, CalibrationGroup& group,
                                      const CalibrationScene& scene, const CalibrationSettings& settings,
                                      const PointOptions& options);

}  // namespace glint::measure

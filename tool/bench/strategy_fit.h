// From measurements of generated scenes to the constants of plan/strategy_cost.h, and how far these can be
// trusted. Pure.
#pragma once

#include "bench/calibration_point.h"
#include "plan/strategy_cost.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace glint::bench {

// How far estimates are from measurements that the constants were not fitted to (see FitQuality::held).
struct StrategyQuality {
    std::string strategy;
    std::size_t points = 0;
    double medianError = 0.0;  // |estimate / measured - 1|
    double worstError = 0.0;
    std::string worstPoint;  // "64 cases, expensive, incoherent, 1000000 rays"
};

// What it costs to choose by the model: the time of the strategy that it takes over that of the fastest,
// less 1. Of points at which two strategies or more were measured.
struct Regret {
    std::size_t points = 0;
    double median = 0.0;
    double worst = 0.0;
    double withinFivePercent = 0.0;  // share of the points
    std::string worstPoint;          // with what was taken and what was fastest
};

struct FitQuality {
    // Each group of points that differ in nothing but their rays was estimated by constants that were fitted
    // to all other groups. With a single group that can't be: then all are of the one fit.
    bool held = false;
    std::vector<StrategyQuality> strategies;
    Regret regret;
};

struct DeviceFit {
    std::vector<StrategyCosts> strategies;  // in the order of kStrategyNames
    FitQuality quality;
    std::vector<std::string> omitted;  // sentences: which strategy has no constants, or which point is no use
};

// Fits each strategy on its own, all constants at least 0, by least squares of relative errors. Points that
// are not usable (times, rays or shares that are no numbers, or out of range) are left out and said. A
// strategy needs as many points as it has terms, and two; else it has no constants.
DeviceFit fitStrategies(std::span<const CalibrationPoint> points, double subgroupSize);

// The point as the model sees it.
Round roundOf(const CalibrationPoint& point);

}  // namespace glint::bench

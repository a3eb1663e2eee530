// Fits the constants of plan/strategy_cost.h to measurements of generated scenes, and says how far they can
// be trusted. Pure.
#pragma once

#include "bench/calibration_point.h"
#include "plan/strategy_cost.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace glint::bench {

// How far estimates are from measurements to which the constants were not fitted (see FitQuality::held).
struct StrategyQuality {
    std::string strategy;
    std::size_t points = 0;
    double medianError = 0.0;  // |estimate / measured - 1|
    double worstError = 0.0;
    std::string worstPoint;  // "64 cases, expensive, incoherent, 1000000 rays"
};

// The cost of choosing by the model: the time of the strategy that it takes over the time of the fastest,
// minus 1. It covers the points at which two or more strategies were measured.
struct Regret {
    std::size_t points = 0;
    double median = 0.0;
    double worst = 0.0;
    double withinFivePercent = 0.0;  // share of the points with a regret of at most 5 %
    std::string worstPoint;          // names the strategy taken and the fastest one
};

struct FitQuality {
    // Each group of points that differ only in their rays was estimated by constants fitted to all other
    // groups. With a single group that is impossible, and all estimates come from the one fit.
    bool held = false;
    std::vector<StrategyQuality> strategies;
    Regret regret;
};

struct DeviceFit {
    std::vector<StrategyCosts> strategies;  // in the order of kStrategyNames
    FitQuality quality;
    std::vector<std::string> omitted;  // sentences that say which strategy has no constants, or which point
                                       // was not usable
};

// Fits each strategy separately, with all constants at least 0, by least squares of relative errors. Points
// that are not usable (times, rays or shares that are not numbers or are out of range) are left out and
// reported. A strategy needs as many points as it has terms, and at least two; otherwise it has no constants.
DeviceFit fitStrategies(std::span<const CalibrationPoint> points, double subgroupSize);

// Returns the point in the form that the model takes.
Round roundOf(const CalibrationPoint& point);

}  // namespace glint::bench

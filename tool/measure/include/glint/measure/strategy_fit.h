// Fits the constants of plan/strategy_cost.h to measurements of generated scenes, and estimates their
// accuracy. Pure.
#pragma once

#include "plan/strategy_cost.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint::measure {

// A case of the scene: its share of all hits (1 over all cases), and the size of its shader's code.
struct CaseWork {
    double share = 0.0;
    double instructions = 0.0;  // SPIR-V instructions in the module with which `visibility` shades the case
    double fetches = 0.0;       // texture fetches in the same module
};

// The device's time in milliseconds for one sample, from the list of rays to their shaded hits. It is the
// median of the first strategy, times the median of this strategy's ratio to it in the same round. A clock
// that changes between rounds does not affect that ratio.
struct StrategyTime {
    std::string strategy;  // as in --strategy
    double ms = 0.0;
};

struct CalibrationPoint {
    std::uint32_t cases = 0;
    std::string cost;            // "cheap" or "expensive"
    std::string coherence;       // "coherent" or "incoherent"
    double rays = 0.0;           // in the list, for one sample
    double hitShare = 0.0;       // share of rays that hit something
    double coherentShare = 0.0;  // share of hits whose neighbours are alike: see coherentShareOf()
    std::vector<CaseWork> work;  // by shader ID
    std::vector<StrategyTime> times;
};

// The difference between estimates and measurements to which the constants were not fitted (see
// FitQuality::held).
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
    // groups. With a single group, all estimates come from the one fit.
    bool held = false;
    std::vector<StrategyQuality> strategies;
    Regret regret;
};

struct DeviceFit {
    std::vector<compiler::StrategyCosts> strategies;  // in the order of simplestFirst()
    FitQuality quality;
    std::vector<std::string> omitted;  // sentences that say which strategy has no constants, or which point
                                       // was not usable
};

// Fits each strategy separately, with all constants at least 0, by least squares of relative errors. Points
// that are not usable (times, rays or shares that are not numbers or are out of range) are left out and
// reported. A strategy needs as many points as it has terms, and at least two; otherwise it has no constants.
DeviceFit fitStrategies(std::span<const CalibrationPoint> points, double subgroupSize);

// Returns the point in the form that the model takes.
compiler::Round roundOf(const CalibrationPoint& point);

}  // namespace glint::measure

// Chooses the strategy that is expected to be fastest, and gives the reasons. Used by --strategy auto and the
// advice of `glint explain`.
#pragma once

#include "plan/strategy_cost.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// The time that a strategy is expected to take for all rounds of a frame, in milliseconds.
struct StrategyEstimate {
    std::string strategy;
    double ms = 0.0;
    TermValues parts{};      // by CostTerm; ms is their sum
    bool available = false;  // can be chosen
};

// A summary of a frame's rounds, for people. Averages are over hits unless a member says otherwise.
struct FrameFacts {
    double rays = 0.0;
    double laterRays = 0.0;  // of these, rays that hits send: the bounces after the first
    std::uint32_t bounces = 1;
    double hits = 0.0;
    std::size_t cases = 0;
    double instructions = 0.0;  // to shade a hit, with kFetchCost for each fetch
    double coherence = 0.0;     // average over rays
    double casesRun = 0.0;      // cases that a subgroup of unsorted hits runs one after another
};
FrameFacts factsOf(std::span<const Round> rounds, double subgroupSize);

// A strategy and its expected time.
struct ChoiceTime {
    std::string_view strategy;
    double ms = 0.0;
};
// Returns whether `a` is the better choice: it is faster. With one case a strategy that orders hits is never
// better than one that doesn't, because there is nothing to order; an estimate that says otherwise is wrong.
bool isBetterChoice(const ChoiceTime& a, const ChoiceTime& b, std::size_t cases);

struct StrategyChoice {
    std::string strategy;
    std::string why;  // full sentences
    FrameFacts facts;
    std::vector<StrategyEstimate> estimates;  // in the order of simplestFirst(); only those that have
                                              // constants
};

// Chooses the fastest of `available` (a subset of simplestFirst()) for the sum of `rounds`. If several are
// equal, it takes the first in simplestFirst(); with one case it takes none that orders hits, unless there is
// no other. Without rays it takes the first that is available. Returns nothing if the device has no constants
// for any of them.
std::optional<StrategyChoice> chooseStrategy(std::span<const Round> rounds, const DeviceCosts& device,
                                             std::span<const std::string> available);

// A choice, and the facts on which it is based.
struct StrategyAdvice {
    StrategyChoice choice;
    std::string device;   // the device whose constants were used
    bool builtIn = true;  // The constants are built in rather than from a calibration.
    double pixels = 0.0;  // pixels of the assumed frame
};

}  // namespace glint::compiler

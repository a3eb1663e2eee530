// Which strategy is expected to be fastest, and why: --strategy auto and the advice of `glint explain`.
#pragma once

#include "plan/strategy_cost.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// What a strategy is expected to take for all rounds of a frame, milliseconds.
struct StrategyEstimate {
    std::string strategy;
    double ms = 0.0;
    TermValues parts{};      // by CostTerm; ms is their sum
    bool available = false;  // among those that can be chosen
};

// What the rounds of a frame have in common, for people; averages are over hits.
struct FrameFacts {
    double rays = 0.0;
    double hits = 0.0;
    std::size_t cases = 0;
    double instructions = 0.0;  // that shading a hit takes, with kFetchCost for each fetch
    double coherence = 0.0;     // over rays
    double casesRun = 0.0;      // by a subgroup of unsorted hits, one after another
};
FrameFacts factsOf(std::span<const Round> rounds, double subgroupSize);

// A strategy and what it is expected to take.
struct ChoiceTime {
    std::string_view strategy;
    double ms = 0.0;
};
// Whether a is taken rather than b: the faster one, but of one case none that orders hits, as there is
// nothing to order; that an estimate says otherwise is its error.
bool isBetterChoice(const ChoiceTime& a, const ChoiceTime& b, std::size_t cases);

struct StrategyChoice {
    std::string strategy;
    std::string why;  // sentences
    FrameFacts facts;
    std::vector<StrategyEstimate> estimates;  // in the order of kStrategyNames; those that have constants
};

// The fastest of `available` (of kStrategyNames) for the sum of `rounds`; of equals the first in
// kStrategyNames; of one case none that orders hits, if there is another. Without rays that is the first one
// that is available. Nothing where the device has no constants of any.
std::optional<StrategyChoice> chooseStrategy(std::span<const Round> rounds, const DeviceCosts& device,
                                             std::span<const std::string> available);

// A choice with what it stands on.
struct StrategyAdvice {
    StrategyChoice choice;
    std::string device;   // whose constants they are
    bool builtIn = true;  // rather than of a calibration
    double pixels = 0.0;  // of the frame that was thought of
};

}  // namespace glint

// The time that frames are expected to take with one choice of cases or another: what --merge auto compares.
//
// A frame shades the first hits of the camera, a dispatch a case with every strategy, and the hits of rays as
// its strategy does (plan/strategy_cost.h). The best cases depend on the strategy: a switch over many is slow
// where hits are mixed, since lanes wait for each case of their subgroup, and keys that share a case share
// the code that they have in common; where hits are sorted, branches are what a case of many keys costs.
#pragma once

#include "plan/frame_rounds.h"
#include "plan/merge.h"
#include "plan/plan.h"
#include "plan/strategy_cost.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace glint::compiler {

// The rays of a frame of one scene, and the keys that they hit.
struct SceneRays {
    std::vector<Round> rounds;      // without cases
    std::vector<WeightedKey> keys;  // of the plan, with their hits in this scene
};

struct FrameModel {
    std::vector<SceneRays> scenes;
    FrameShape shape;
    DeviceCosts device;
    std::vector<std::string> strategies;  // for which cases are chosen; those without constants do not count
    bool takesFastest = false;            // one of them will run, whichever is fastest; else each may
};

// Estimates this close to each other say nothing about which is faster.
inline constexpr double kSameTime = 0.03;  // relative

// Returns an estimate of each candidate. The fastest is so with the fastest strategy, or over all strategies,
// each by its time over that of its best candidate. Of those within kSameTime of the fastest the one with
// fewest cases is chosen, since each takes time to compile and memory. `keys` are those of the candidates,
// with their hits in all scenes.
std::vector<MergeEstimate> estimateMerges(const FrameModel& model, std::span<const WeightedKey> keys,
                                          std::span<const MergeCandidate> candidates);

// Says which cases were chosen and what the other policies would take, for people: a sentence without a full
// stop. `strategies` and `takesFastest` are those of the model; there is at least one strategy.
std::string describeChoice(std::span<const MergeEstimate> estimates, std::span<const std::string> strategies,
                           bool takesFastest);

}  // namespace glint::compiler

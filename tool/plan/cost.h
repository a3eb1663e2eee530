// What it costs that keys share a case: the model behind --merge auto.
//
// Unit: SPIR-V instructions that an average hit runs in vain. A hit runs the code of its own features in any
// clustering, so only the surplus counts. A case whose hits have the share w of all hits costs
//
//     w * sum over its "sometimes" features f of ( branch(f) + code(f) * (q(f) - p(f)) )  + kCaseCost
//
//   p(f)       share of the case's hits that have f
//   q(f)       chance that some lane of a subgroup has f, 1 - (1 - p)^kSubgroupSize, if neighbours are
//              independent: the others wait for that lane. Neighbours are often alike, so this is an upper
//              bound.
//   code(f)    instructions(f) + kFetchCost * fetches(f): what a shader grows by with f
//   branch(f)  what a case grows by beyond its features' own code when f becomes a branch, which all of its
//              hits pay in tests, selects and registers: kInputBranch, kLobeBranch
//
// Lit shading is such a feature too, which unlit keys lack. Instructions, fetches and branches are measured:
// cost_constants.h. What stands here is chosen.
#pragma once

#include "plan/features.h"

#include <array>
#include <span>

namespace glint {

// Instructions that a texture fetch weighs besides its own, which make its coordinates and level. A choice:
// it hides behind other work or waits for memory, by device and scene.
inline constexpr double kFetchCost = 20.0;

// Lanes of a subgroup on most GPUs (8 on lavapipe, 64 on some).
inline constexpr int kSubgroupSize = 32;

// One per cent of a plain lit hit. A case brings a dispatch whose last workgroup is half empty or, in an uber
// shader, one more way for a subgroup to diverge; some 25 kB of SPIR-V; and a tenth of a second or more to
// compile. This is a choice rather than a measurement: what they weigh depends on the GPU.
inline constexpr double kCaseCost = 10.0;

// A key, and the share of all hits that have it: not negative, 1 over all keys or 0 each.
struct WeightedKey {
    FeatureMask mask = 0;
    double share = 0.0;
};

// What the model needs to know of a set of keys.
struct KeySet {
    double share = 0.0;
    FeatureMask always = 0;
    FeatureMask any = 0;
    std::array<double, 64> shareWith{};  // by bit: the part of `share` whose keys have it
};

KeySet toSet(const WeightedKey& key);
// Of the keys with these indices, at least one.
KeySet toSet(std::span<const int> indices, std::span<const WeightedKey> keys);
KeySet unionOf(const KeySet& a, const KeySet& b);

// The surplus of a case of these keys, without kCaseCost. Never negative; 0 for one key.
double mergingCost(const KeySet& keys);
// The surplus of a case of the keys of both.
double mergingCost(const KeySet& a, const KeySet& b);

// The surplus that one feature of `keys` brings, of which some keys have it and some don't.
double branchCost(const KeySet& keys, Feature feature);

// What the shader of a case is expected to hold; compiling it gives the truth.
struct CodeEstimate {
    double instructions = 0.0;
    double fetches = 0.0;
    int inputBranches = 0;
    int lobeBranches = 0;
};
CodeEstimate estimateCode(FeatureMask always, FeatureMask sometimes);

}  // namespace glint

// The cost of keys that share a case, in code: what the ways to merge of --merge auto are made and compared
// by (plan/merge.h, plan/frame_time.h).
//
// The unit is SPIR-V instructions that an average hit runs in vain. A hit runs the code of its own features
// in any clustering, so only the surplus counts. A case that gets the share w of all hits costs
//
//     w * sum over its "sometimes" features f of ( branch(f) + code(f) * (q(f) - p(f)) )  + kCaseCost
//
//   p(f)       share of the case's hits that have f
//   q(f)       chance that some lane of a subgroup has f, so that the others wait for it:
//              1 - (1 - p)^kSubgroupSize if neighbours are independent. Neighbours are often alike, so this
//              is an upper bound.
//   code(f)    instructions(f) + kFetchCost * fetches(f): how much a shader grows with f
//   branch(f)  how much a case grows beyond its features' own code when f becomes a branch. All of its hits
//              pay for it in tests, selects and registers: kInputBranch, kLobeBranch
//
// On a GPU with a table of its compiler's statistics, an instruction takes m times as long in a case that
// branches, because such shaders hold more registers. Its cost is then w * ( (m - 1) * own code + m * sum
// above ) + kCaseCost.
//
// Lit shading counts as such a feature too, which unlit keys lack. Instructions, fetches and branches are
// measured (cost_constants.h, and "cost" in each declaration). The constants in this file are chosen.
#pragma once

#include "materials/material_model.h"

#include <span>
#include <utility>
#include <vector>

namespace glint::compiler {

// The weight of a texture fetch in instructions, on top of those that make its coordinates and level. It is a
// choice: a fetch hides behind other work or waits for memory, which depends on the device and the scene.
inline constexpr double kFetchCost = 20.0;

// The number of lanes of a subgroup on most GPUs (8 on lavapipe, 64 on some GPUs).
inline constexpr int kSubgroupSize = 32;

// One per cent of a plain lit hit. A further case brings a dispatch whose last workgroup is half empty or, in
// an uber shader, one more way for a subgroup to diverge. It also brings some 25 kB of SPIR-V and takes a
// tenth of a second or more to compile. This is a choice rather than a measurement, because the weight of
// these depends on the GPU.
inline constexpr double kCaseCost = 10.0;

// A key and its share of all hits. Shares are not negative; they add up to 1 over all keys, or all of them
// are 0.
struct WeightedKey {
    materials::FeatureMask mask = 0;
    double share = 0.0;
    const materials::MaterialModel* model = &materials::builtinMaterialModel();  // the same for all keys
    // The factor by which an instruction takes longer in a case that branches; the same for all keys, at
    // least 1. It is known for GPUs with a table of their compiler's statistics (plan/gpu_costs.h).
    double branchFactor = 1.0;
};

// A share for each feature by its bit. What is not added is 0.
class FeatureShares {
public:
    double operator[](int bit) const;
    void add(int bit, double share);
    void add(const FeatureShares& other);
    void remove(int bit);

    bool operator==(const FeatureShares&) const = default;

private:
    std::vector<std::pair<int, double>> shares_;  // by bit
};

// The facts about a set of keys that the model needs.
struct KeySet {
    double share = 0.0;
    materials::FeatureMask always = 0;
    materials::FeatureMask any = 0;
    FeatureShares shareWith;  // the total share of the keys that have a feature
    const materials::MaterialModel* model = &materials::builtinMaterialModel();
    double branchFactor = 1.0;
};

KeySet toSet(const WeightedKey& key);
// Requires at least one index.
KeySet toSet(std::span<const int> indices, std::span<const WeightedKey> keys);
KeySet unionOf(const KeySet& a, const KeySet& b);

// Returns the surplus of a case with these keys, without kCaseCost. It is never negative, and 0 for one key.
double mergingCost(const KeySet& keys);
// Returns the surplus of a case with the keys of both sets.
double mergingCost(const KeySet& a, const KeySet& b);

// Returns the surplus that comes from one feature which some of `keys` have and others don't.
double branchCost(const KeySet& keys, const materials::Feature& feature);

// An estimate of the code that the shader of a case holds; only compiling it gives the exact numbers.
struct CodeEstimate {
    double instructions = 0.0;
    double fetches = 0.0;
    int inputBranches = 0;
    int lobeBranches = 0;
};
CodeEstimate estimateCode(const materials::FeatureMask& always, const materials::FeatureMask& sometimes,
                          const materials::MaterialModel& model = materials::builtinMaterialModel());

// Code that some hits of a case run, and others don't.
struct PartialCode {
    double share = 0.0;  // of the case's hits
    double instructions = 0.0;
    double fetches = 0.0;
};

// The estimated code of a case, by the hits that run it.
struct CaseCode {
    CodeEstimate always;  // which all of its hits run, tests of branches included
    std::vector<PartialCode> parts;
};
// If nothing hits the case, all of its hits are expected to run everything.
CaseCode codeOf(const KeySet& keys);

}  // namespace glint::compiler

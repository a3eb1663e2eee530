// Keys and cases: which permutations a scene has, and which share code. Pure functions.
#pragma once

#include "plan/effects.h"
#include "plan/features.h"
#include "plan/lock_ids.h"
#include "plan/merge.h"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

struct PlanOptions {
    KeyOptions keys;
    MergePolicy merge = MergePolicy::Family;
    // Auto and Profile make no more cases, the other policies are told by describeExcess(); 0: no limit, but
    // kDefaultMaxCases for Auto and Profile.
    int maxShaders = 0;
    // Hits that were counted, by key, for Profile and, if there are any, for Auto. A key that is not there
    // was never hit.
    std::map<FeatureMask, std::uint64_t> hits{};
    // Shader IDs that keys had before: their cases keep them.
    LockedIds lockedIds{};
};

// A feature that the file asks for and the key leaves out.
struct DroppedFeature {
    std::string feature;  // name in the table, or a glTF extension
    std::string reason;
    std::vector<int> materials;  // ascending
};

// The set of features that shading hits of some primitives needs.
struct Key {
    FeatureMask mask = 0;
    std::vector<int> materials;   // ascending
    std::vector<int> primitives;  // indices into the plan's primitives, ascending
    int shaderId = 0;
    double share = 0.0;  // of all hits, as counted or expected; 1 over all keys, or 0 each
};

// Keys that share one piece of code. always & sometimes is 0.
struct Case {
    int shaderId = 0;  // equal to its place in Plan::cases
    std::string name;  // C++ identifier, unique in the plan
    FeatureMask always = 0;
    FeatureMask sometimes = 0;
    std::vector<int> keys;       // ascending
    std::vector<int> materials;  // ascending
    double share = 0.0;          // of all hits: that of its keys
    CaseReason reason = CaseReason::Own;

    // An ID below others that nothing has, for instance one that is kept for keys which may come back. It
    // needs no code.
    bool isRetired() const {
        return keys.empty();
    }
};

// Keys and cases are those of hits. Primary surfaces keep every lobe (KeyOptions::keptLobes); the key of a
// primitive's hits is part of its primary mask, and the same where hits keep all.
struct Plan {
    std::vector<Key> keys;            // ascending by mask
    std::vector<Case> cases;          // by shader ID
    std::vector<int> keyOfPrimitive;  // by primitive
    std::vector<FeatureMask> primaryMaskOfPrimitive;
    std::vector<DroppedFeature> dropped;
    FeatureMask always = 0;     // features of every key
    FeatureMask sometimes = 0;  // features of some keys
    FeatureMask primaryAlways = 0;
    FeatureMask primarySometimes = 0;
    double keysPossible = 0.0;  // 2^n for n features that occur in keys
    EffectPlan effects;         // filled in by the compiler
};

// The canonical key of one primitive. `dropped`, if not null, receives (feature name, reason) pairs.
FeatureMask makeKey(const Material& material, const PrimitiveInputs& primitive, const KeyOptions& options,
                    std::vector<std::pair<std::string, std::string>>* dropped = nullptr);

// The same options for primary surfaces.
KeyOptions keepAllLobes(KeyOptions options);

// Whether shares of hits are as counted, rather than as the primitives expect them.
bool countsHits(const PlanOptions& options);

// Clusters the keys of `primitives`. Requires every PrimitiveInputs::material to index `materials`.
Plan makePlan(std::span<const Material> materials, std::span<const PrimitiveInputs> primitives,
              const PlanOptions& options);

// Cases that a plan may have at most; 0: no limit.
int budgetOf(const PlanOptions& options);

// Cases that are not retired.
std::size_t caseCount(const Plan& plan);

// What to tell the user when the plan has more cases than options.maxShaders; nothing if it fits.
std::optional<std::string> describeExcess(const Plan& plan, const PlanOptions& options);

std::string_view toString(AlphaPolicy alpha);

}  // namespace glint

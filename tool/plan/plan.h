// Keys and cases: the permutations of a scene, and the ones that share code. Pure functions.
#pragma once

#include "plan/effects.h"
#include "plan/key.h"
#include "plan/lock.h"
#include "plan/merge.h"

#include <glint/layers.h>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

struct PlanOptions {
    materials::KeyOptions keys;
    MergePolicy merge = MergePolicy::Family;
    // Auto and Profile make no more cases than this. The other policies may exceed it, and describeExcess()
    // then says so. 0 means no limit, but kDefaultMaxCases for Auto and Profile.
    int maxShaders = 0;
    // The package also gets a shader for every material, whose features are those of all keys. Then no
    // feature is certain for the package as a whole.
    bool fallback = false;
    // Counted hits by key. Profile needs them, and Auto uses them if there are any. A key that is not in the
    // map was never hit.
    std::map<materials::FeatureMask, std::uint64_t> hits{};
    double branchFactor = 1.0;  // of WeightedKey
    // Shader IDs that keys had in earlier builds; their cases keep them.
    LockedIds lockedIds{};
};

// A feature that the file asks for but the key leaves out.
struct DroppedFeature {
    std::string feature;  // name in the table, or a glTF extension
    std::string reason;
    std::vector<int> materials;  // ascending
};

// A set of features that shading the hits of some primitives needs.
struct Key {
    materials::FeatureMask mask = 0;
    std::vector<int> materials;   // ascending
    std::vector<int> primitives;  // indices into the plan's primitives, ascending
    int shaderId = 0;
    double share = 0.0;  // of all hits, as counted or expected; adds up to 1 over all keys, or all are 0
};

// The keys that share one piece of code. always & sometimes is 0.
struct Case {
    int shaderId = 0;  // equal to its place in Plan::cases
    std::string name;  // C++ identifier, unique in the plan
    materials::FeatureMask always = 0;
    materials::FeatureMask sometimes = 0;
    std::vector<int> keys;       // ascending
    std::vector<int> materials;  // ascending
    double share = 0.0;          // of all hits: the sum over its keys
    CaseReason reason = CaseReason::Own;

    // Returns whether no key has this ID although higher IDs are in use, for instance because it is kept for
    // keys that may return. A retired case needs no code.
    bool isRetired() const {
        return keys.empty();
    }
};

// The features that decide what emissive triangles emit: those that all of them have, and those that some
// have. If a layer covers the emission of one, they are all features. In a package with a fallback any
// material of the plan's features may become a light, so none is taken for granted.
struct EmitterFeatures {
    materials::FeatureMask read = 0;  // that emission may depend on
    materials::FeatureMask always = 0;
    materials::FeatureMask sometimes = 0;
    bool coveredByLayers = false;
};

// Materials whose records have the same fields: those of one base model, and of others where a material has
// keys of several.
struct RecordUse {
    std::vector<int> models;          // ascending indices into MaterialModel::models; -1: glTF's bases
    materials::FeatureMask used = 0;  // features that their keys may have
    bool masks = false;               // alphaMode of some is not OPAQUE

    bool operator==(const RecordUse&) const = default;
};

// The keys and cases are those of hits. Primary surfaces keep every lobe (KeyOptions::keptLobes): the key of
// a primitive's hits is part of its primary mask, and equals it if hits keep all lobes.
struct Plan {
    const materials::MaterialModel* model = &materials::builtinMaterialModel();  // of all materials
    std::vector<Key> keys;                                                       // ascending by mask
    std::vector<Case> cases;                                                     // by shader ID
    std::vector<int> keyOfPrimitive;                                             // by primitive
    std::vector<materials::FeatureMask> primaryMaskOfPrimitive;
    std::vector<DroppedFeature> dropped;
    materials::FeatureMask always = 0;     // features that all keys have
    materials::FeatureMask sometimes = 0;  // features that only some keys have
    materials::FeatureMask primaryAlways = 0;
    materials::FeatureMask primarySometimes = 0;
    std::vector<RecordUse> records{{{-1}, 0, false}};  // of all materials of primitives; never empty
    double keysPossible = 0.0;  // 2^n, where n is the number of features that occur in keys
    EffectPlan effects;         // resolve() fills this in, and the next two.
    std::vector<package::LayerInfo::Entry> layers{};  // by the index of their images
    EmitterFeatures emitters{};
};

// Returns whether the shares of hits are counted rather than expected from the primitives.
bool countsHits(const PlanOptions& options);

// Returns the plan's keys as the cost model takes them.
std::vector<WeightedKey> weightedKeys(const Plan& plan, const PlanOptions& options);

// Returns the cases of a plan whose keys have their shares, for MergePolicy::Auto.
using CaseChooser = std::function<std::vector<CaseKeys>(const Plan& plan)>;

// Returns a plan with the keys of `primitives`, before hits and cases are known. Requires every
// PrimitiveInputs::material to index `materials`, and one model for all of these.
Plan planKeys(std::span<const materials::Material> materials,
              std::span<const materials::PrimitiveInputs> primitives, const materials::KeyOptions& options);
// Completes what planKeys() returned for `primitives` with options.keys: clusters the keys into cases.
// Without `choose` Auto makes those with which an average hit runs fewest instructions in vain.
Plan planCases(Plan keys, std::span<const materials::PrimitiveInputs> primitives, const PlanOptions& options,
               const CaseChooser& choose = {});
// Does both.
inline Plan makePlan(std::span<const materials::Material> materials,
                     std::span<const materials::PrimitiveInputs> primitives, const PlanOptions& options) {
    return planCases(planKeys(materials, primitives, options.keys), primitives, options);
}

// Returns the features that hits or primary surfaces have.
inline materials::FeatureMask usedFeatures(const Plan& plan) {
    return plan.always | plan.sometimes | plan.primaryAlways | plan.primarySometimes;
}

// Returns the case of materials that have no case in the plan. It has every feature of the plan as one that a
// material may have, and no shader ID, keys or materials.
Case fallbackCase(const Plan& plan);

// Returns the case with which first hits of those materials are shaded: primary surfaces keep lobes that hits
// of rays may drop. `shaderCase` is one of the plan's, or its fallbackCase().
Case firstCase(const Plan& plan, const Case& shaderCase);

// Returns the case of the draft of first hits: the features of primary surfaces that it shows.
Case draftCase(const Plan& plan);

// Returns the largest number of cases that a plan may have; 0 means no limit.
int budgetOf(const PlanOptions& options);

// Returns the number of cases that are not retired.
std::size_t caseCount(const Plan& plan);

// Returns a message for the user if the plan has more cases than options.maxShaders.
std::optional<std::string> describeExcess(const Plan& plan, const PlanOptions& options);

}  // namespace glint::compiler

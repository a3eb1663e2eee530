// Keys and cases: which permutations a scene has, and which share code. Pure functions.
#pragma once

#include "plan/features.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

enum class MergePolicy : std::uint8_t { None, Family, All };

struct PlanOptions {
    KeyOptions keys;
    MergePolicy merge = MergePolicy::Family;
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
};

// Keys that share one piece of code. always & sometimes is 0.
struct Case {
    int shaderId = 0;  // equal to its place in Plan::cases
    std::string name;  // C++ identifier, unique in the plan
    FeatureMask always = 0;
    FeatureMask sometimes = 0;
    std::vector<int> keys;       // ascending
    std::vector<int> materials;  // ascending
};

// Keys and cases are those of hits. Primary surfaces keep every lobe (KeyOptions::keptLobes); the key of a
// primitive's hits is part of its primary mask, and the same where hits keep all.
struct Plan {
    std::vector<Key> keys;            // ascending by mask
    std::vector<Case> cases;          // ascending by their smallest key
    std::vector<int> keyOfPrimitive;  // by primitive
    std::vector<FeatureMask> primaryMaskOfPrimitive;
    std::vector<DroppedFeature> dropped;
    FeatureMask always = 0;     // features of every key
    FeatureMask sometimes = 0;  // features of some keys
    FeatureMask primaryAlways = 0;
    FeatureMask primarySometimes = 0;
    double keysPossible = 0.0;  // 2^n for n features that occur in keys
};

// The canonical key of one primitive. `dropped`, if not null, receives (feature name, reason) pairs.
FeatureMask makeKey(const Material& material, const PrimitiveInputs& primitive, const KeyOptions& options,
                    std::vector<std::pair<std::string, std::string>>* dropped = nullptr);

// The same options for primary surfaces.
KeyOptions keepAllLobes(KeyOptions options);

// Clusters the keys of `primitives`. Requires every PrimitiveInputs::material to index `materials`.
Plan makePlan(std::span<const Material> materials, std::span<const PrimitiveInputs> primitives,
              const PlanOptions& options);

// What to tell the user when the plan has more than `maxShaders` cases; nothing if it fits.
std::optional<std::string> describeExcess(const Plan& plan, MergePolicy merge, int maxShaders);

std::string_view toString(MergePolicy merge);
std::string_view toString(AlphaPolicy alpha);

}  // namespace glint

#include "plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <map>
#include <set>

namespace glint {

namespace {

using DroppedMap = std::map<std::pair<std::string, std::string>, std::set<int>>;

void appendUnique(std::vector<int>& sorted, const std::vector<int>& more) {
    sorted.insert(sorted.end(), more.begin(), more.end());
    std::ranges::sort(sorted);
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
}

// Gives each primitive its key; keys come out in ascending order of their masks.
void collectKeys(std::span<const Material> materials, std::span<const PrimitiveInputs> primitives,
                 const KeyOptions& options, Plan& plan, DroppedMap& droppedBy) {
    std::map<FeatureMask, Key> byMask;
    std::vector<FeatureMask> masks;
    masks.reserve(primitives.size());
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        const int materialIndex = primitives[i].material;
        assert(materialIndex >= 0 && static_cast<std::size_t>(materialIndex) < materials.size());
        std::vector<std::pair<std::string, std::string>> dropped;
        const FeatureMask mask = makeKey(materials[materialIndex], primitives[i], options, &dropped);
        masks.push_back(mask);
        plan.primaryMaskOfPrimitive.push_back(
            makeKey(materials[materialIndex], primitives[i], keepAllLobes(options)));
        Key& key = byMask[mask];
        key.mask = mask;
        key.primitives.push_back(static_cast<int>(i));
        if (std::ranges::find(key.materials, materialIndex) == key.materials.end()) {
            key.materials.push_back(materialIndex);
        }
        for (auto& entry : dropped) {
            droppedBy[std::move(entry)].insert(materialIndex);
        }
    }
    std::map<FeatureMask, int> indexOf;
    for (auto& [mask, key] : byMask) {
        std::ranges::sort(key.materials);
        indexOf[mask] = static_cast<int>(plan.keys.size());
        plan.keys.push_back(std::move(key));
    }
    for (const FeatureMask mask : masks) {
        plan.keyOfPrimitive.push_back(indexOf[mask]);
    }
}

struct FeatureSpread {
    FeatureMask always = 0;     // features of every mask
    FeatureMask sometimes = 0;  // features of some
};

FeatureSpread spreadOf(const std::vector<FeatureMask>& masks) {
    FeatureMask any = 0;
    FeatureMask every = masks.empty() ? 0 : ~FeatureMask{0};
    for (const FeatureMask mask : masks) {
        any |= mask;
        every &= mask;
    }
    return {every, any & ~every};
}

// Which cluster a key belongs to: keys with equal values share a case.
FeatureMask clusterOf(FeatureMask mask, MergePolicy merge) {
    switch (merge) {
        case MergePolicy::None:
            return mask;
        case MergePolicy::Family:
            return mask & kLobeMask;
        case MergePolicy::All:
            break;
    }
    return 0;
}

// A case's features as an identifier: "Pbr_BaseTex_Normals", or "PbrFamily" where keys differ.
std::string nameCase(const Case& shaderCase, MergePolicy merge) {
    const bool merged = shaderCase.sometimes != 0;
    if (merged && merge == MergePolicy::All) {
        return "AllMaterials";
    }
    std::string lobes;
    std::string inputs;
    for (const FeatureInfo& info : featureTable()) {
        if ((shaderCase.always & bit(info.feature)) == 0) {
            continue;
        }
        if ((bit(info.feature) & kLobeMask) != 0) {
            lobes += info.shortName;
        } else {
            inputs += fmt::format("_{}", info.shortName);
        }
    }
    const std::string base = lobes.empty() ? "Pbr" : lobes;
    return merged ? base + "Family" : base + inputs;
}

void clusterKeys(MergePolicy merge, Plan& plan) {
    std::map<FeatureMask, int> caseOf;
    for (std::size_t i = 0; i < plan.keys.size(); ++i) {
        Key& key = plan.keys[i];
        const auto [place, isNew] =
            caseOf.try_emplace(clusterOf(key.mask, merge), static_cast<int>(plan.cases.size()));
        if (isNew) {
            Case shaderCase;
            shaderCase.shaderId = place->second;
            shaderCase.always = key.mask;
            plan.cases.push_back(std::move(shaderCase));
        }
        Case& shaderCase = plan.cases[place->second];
        shaderCase.sometimes |= shaderCase.always ^ key.mask;
        shaderCase.always &= key.mask;
        shaderCase.keys.push_back(static_cast<int>(i));
        appendUnique(shaderCase.materials, key.materials);
        key.shaderId = shaderCase.shaderId;
    }
    for (Case& shaderCase : plan.cases) {
        // Features that some keys lack are never "always", whichever key came first.
        shaderCase.sometimes &= ~shaderCase.always;
        shaderCase.name = nameCase(shaderCase, merge);
    }
}

}  // namespace

Plan makePlan(std::span<const Material> materials, std::span<const PrimitiveInputs> primitives,
              const PlanOptions& options) {
    Plan plan;
    DroppedMap droppedBy;
    collectKeys(materials, primitives, options.keys, plan, droppedBy);
    clusterKeys(options.merge, plan);

    std::vector<FeatureMask> hitMasks;
    for (const Key& key : plan.keys) {
        hitMasks.push_back(key.mask);
    }
    const FeatureSpread hits = spreadOf(hitMasks);
    const FeatureSpread primary = spreadOf(plan.primaryMaskOfPrimitive);
    plan.always = hits.always;
    plan.sometimes = hits.sometimes;
    plan.primaryAlways = primary.always;
    plan.primarySometimes = primary.sometimes;
    plan.keysPossible = plan.keys.empty() ? 0.0 : std::exp2(std::popcount(hits.always | hits.sometimes));
    for (auto& [what, materialSet] : droppedBy) {
        plan.dropped.push_back({what.first, what.second, {materialSet.begin(), materialSet.end()}});
    }
    return plan;
}

std::optional<std::string> describeExcess(const Plan& plan, MergePolicy merge, int maxShaders) {
    if (maxShaders <= 0 || plan.cases.size() <= static_cast<std::size_t>(maxShaders)) {
        return std::nullopt;
    }
    std::set<FeatureMask> families;
    for (const Key& key : plan.keys) {
        families.insert(clusterOf(key.mask, MergePolicy::Family));
    }
    std::string advice = "raise --max-shaders";
    if (merge == MergePolicy::None && families.size() <= static_cast<std::size_t>(maxShaders)) {
        advice = fmt::format("use --merge family, which needs {}, or {}", families.size(), advice);
    } else {
        advice = fmt::format("use --merge all, which needs 1, or {}", advice);
    }
    return fmt::format("the plan needs {} cases for {} keys; the limit is {}: {}", plan.cases.size(),
                       plan.keys.size(), maxShaders, advice);
}

std::string_view toString(MergePolicy merge) {
    switch (merge) {
        case MergePolicy::None:
            return "none";
        case MergePolicy::Family:
            return "family";
        case MergePolicy::All:
            break;
    }
    return "all";
}

std::string_view toString(AlphaPolicy alpha) {
    return alpha == AlphaPolicy::Opaque ? "opaque" : "tested";
}

}  // namespace glint

#include "plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <memory>
#include <set>

namespace glint::compiler {

namespace {

using DroppedMap = std::map<std::pair<std::string, std::string>, std::set<int>>;

void appendUnique(std::vector<int>& sorted, const std::vector<int>& more) {
    sorted.insert(sorted.end(), more.begin(), more.end());
    std::ranges::sort(sorted);
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
}

// Gives each primitive its key. The keys are in ascending order of their masks.
void collectKeys(std::span<const materials::Material> materials,
                 std::span<const materials::PrimitiveInputs> primitives, const materials::KeyOptions& options,
                 Plan& plan, DroppedMap& droppedBy) {
    std::map<materials::FeatureMask, Key> byMask;
    std::vector<materials::FeatureMask> masks;
    masks.reserve(primitives.size());
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        const int materialIndex = primitives[i].material;
        assert(materialIndex >= 0 && static_cast<std::size_t>(materialIndex) < materials.size());
        std::vector<std::pair<std::string, std::string>> dropped;
        const materials::FeatureMask mask =
            makeKey(materials[materialIndex], primitives[i], options, &dropped);
        masks.push_back(mask);
        const bool keepsAll = (options.keptLobes & plan.model->lobes) == plan.model->lobes;
        plan.primaryMaskOfPrimitive.push_back(
            keepsAll ? mask : makeKey(materials[materialIndex], primitives[i], keepAllLobes(options)));
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
    std::map<materials::FeatureMask, int> indexOf;
    for (auto& [mask, key] : byMask) {
        std::ranges::sort(key.materials);
        indexOf[mask] = static_cast<int>(plan.keys.size());
        plan.keys.push_back(std::move(key));
    }
    for (const materials::FeatureMask& mask : masks) {
        plan.keyOfPrimitive.push_back(indexOf[mask]);
    }
}

bool mayLeaveOut(const materials::MaterialModel& model, int base) {
    const materials::Feature& feature =
        model.features[static_cast<std::size_t>(model.models[static_cast<std::size_t>(base)].feature)];
    const int index = model.models[static_cast<std::size_t>(base)].feature;
    return !feature.neutral.empty() || feature.given || feature.needsTexCoord >= 0 ||
           std::ranges::any_of(model.attributes, [&](const materials::VertexAttribute& attribute) {
               return attribute.feature == index && !attribute.fallback;
           });
}

// Groups the models of materials. A material with keys of several models puts these into one group.
std::vector<RecordUse> recordUses(std::span<const materials::Material> materials,
                                  std::span<const materials::PrimitiveInputs> primitives, const Plan& plan) {
    const materials::MaterialModel& model = *plan.model;
    std::map<int, std::shared_ptr<RecordUse>> byModel;
    const auto join = [&byModel](RecordUse use) {
        const std::vector<int> joined = use.models;
        for (const int one : joined) {
            const auto other = byModel.find(one);
            if (other != byModel.end()) {
                appendUnique(use.models, other->second->models);
                use.used |= other->second->used;
                use.masks = use.masks || other->second->masks;
            }
        }
        const auto whole = std::make_shared<RecordUse>(std::move(use));
        for (const int one : whole->models) {
            byModel[one] = whole;
        }
    };
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        const materials::Material& material = materials[static_cast<std::size_t>(primitives[i].material)];
        const materials::FeatureMask& key = plan.primaryMaskOfPrimitive[i];
        RecordUse use{{}, key, material.alphaMode != materials::AlphaMode::Opaque};
        const int named = modelOf(material);
        appendUnique(use.models, {model.modelOf(key), named});
        if (named >= 0 && mayLeaveOut(model, named)) {
            appendUnique(use.models, {-1});
        }
        join(std::move(use));
    }
    if (byModel.empty()) {
        return {{{-1}, 0, false}};
    }
    std::vector<RecordUse> uses;
    for (const auto& [one, use] : byModel) {
        if (one == use->models.front()) {
            uses.push_back(*use);
        }
    }
    return uses;
}

// Adds the features of materials that edits choose: those of a case whose keys are of the model, those that
// hits do not keep, and with a fallback those of all keys.
void addFeaturesOfEdits(const Plan& plan, bool fallback, std::vector<RecordUse>& uses) {
    const materials::MaterialModel& model = *plan.model;
    const materials::FeatureMask primary = plan.primaryAlways | plan.primarySometimes;
    const materials::FeatureMask dropped = primary & ~(plan.always | plan.sometimes);
    const bool masks = std::ranges::any_of(uses, &RecordUse::masks);
    std::map<int, std::set<const Case*>> casesOf;  // by the models of their keys
    for (const Case& shaderCase : plan.cases) {
        for (const int key : shaderCase.keys) {
            casesOf[model.modelOf(plan.keys[static_cast<std::size_t>(key)].mask)].insert(&shaderCase);
        }
    }
    for (RecordUse& use : uses) {
        materials::FeatureMask more = fallback ? primary : dropped;
        for (const int one : use.models) {
            for (const Case* const shaderCase : casesOf[one]) {
                more |= shaderCase->always | shaderCase->sometimes;
            }
        }
        materials::FeatureMask possible = 0;
        for (const int one : use.models) {
            possible |= model.featuresOf(one);
        }
        use.used |= more & possible;
        use.masks = use.masks || (fallback && masks);
    }
}

struct FeatureSpread {
    materials::FeatureMask always = 0;     // features that all masks have
    materials::FeatureMask sometimes = 0;  // features that only some masks have
};

FeatureSpread spreadOf(const std::vector<materials::FeatureMask>& masks) {
    materials::FeatureMask any = 0;
    materials::FeatureMask every = masks.empty() ? materials::FeatureMask() : materials::kAllFeatures;
    for (const materials::FeatureMask& mask : masks) {
        any |= mask;
        every &= mask;
    }
    return {every, any & ~every};
}

// Scales the shares of all keys so that they add up to 1. Returns false, and sets all to 0, if their sum is
// 0.
bool normalizeShares(std::vector<Key>& keys) {
    double sum = 0.0;
    for (const Key& key : keys) {
        sum += key.share;
    }
    const bool isPositive = sum > 0.0 && std::isfinite(sum);
    for (Key& key : keys) {
        key.share = isPositive ? key.share / sum : 0.0;
    }
    return isPositive;
}

void shareHits(std::span<const materials::PrimitiveInputs> primitives, const PlanOptions& options,
               std::vector<Key>& keys) {
    const bool counted = countsHits(options);
    for (Key& key : keys) {
        const auto found = options.hits.find(key.mask);
        if (counted && found != options.hits.end()) {
            key.share = static_cast<double>(found->second);
        }
        for (std::size_t i = 0; !counted && i < key.primitives.size(); ++i) {
            key.share += primitives[static_cast<std::size_t>(key.primitives[i])].expectedHits;
        }
    }
    if (!normalizeShares(keys) && !counted) {
        for (Key& key : keys) {
            key.share = 1.0 / static_cast<double>(keys.size());
        }
    }
}

// Names a case by its features, as an identifier: "Pbr_BaseTex_Normals"; "PbrFamily" if its keys differ in
// inputs only; "PbrMixed" if they differ in lobes.
std::string nameCase(const materials::MaterialModel& model, const Case& shaderCase, bool hasAllKeys) {
    const bool merged = shaderCase.sometimes != 0;
    if (merged && hasAllKeys) {
        return "AllMaterials";
    }
    std::string lobes;
    std::string inputs;
    for (const int index : model.indicesOf(shaderCase.always)) {
        const materials::Feature& feature = model.features[static_cast<std::size_t>(index)];
        if (feature.isLobe) {
            lobes += feature.shortName;
        } else {
            inputs += fmt::format("_{}", feature.shortName);
        }
    }
    const std::string base = lobes.empty() ? "Pbr" : lobes;
    const bool mixed = (shaderCase.sometimes & model.lobes) != 0;
    return !merged ? base + inputs : base + (mixed ? "Mixed" : "Family");
}

// Makes a case of the given keys, without a name, and stores its ID in those keys.
Case makeCase(int shaderId, CaseKeys merged, std::vector<Key>& keys) {
    Case shaderCase;
    shaderCase.shaderId = shaderId;
    shaderCase.reason = merged.reason;
    std::vector<materials::FeatureMask> masks;
    for (const int index : merged.keys) {
        Key& key = keys[static_cast<std::size_t>(index)];
        key.shaderId = shaderId;
        masks.push_back(key.mask);
        shaderCase.share += key.share;
        appendUnique(shaderCase.materials, key.materials);
    }
    const FeatureSpread spread = spreadOf(masks);
    shaderCase.always = spread.always;
    shaderCase.sometimes = spread.sometimes;
    shaderCase.keys = std::move(merged.keys);
    return shaderCase;
}

void nameCases(Plan& plan) {
    std::map<std::string, int> named;
    for (Case& shaderCase : plan.cases) {
        if (shaderCase.isRetired()) {
            shaderCase.name = fmt::format("Retired_{}", shaderCase.shaderId);
            continue;
        }
        shaderCase.name = nameCase(*plan.model, shaderCase, shaderCase.keys.size() == plan.keys.size());
        // Two cases may get the same name because the name does not say which features they never have.
        if (const int count = ++named[shaderCase.name]; count > 1) {
            shaderCase.name += fmt::format("_{}", count);
        }
    }
}

void makeCases(const PlanOptions& options, const CaseChooser& choose, Plan& plan) {
    const std::vector<WeightedKey> weighted = weightedKeys(plan, options);
    std::vector<CaseKeys> merged = options.merge == MergePolicy::Auto && choose
                                       ? choose(plan)
                                       : mergeKeys(weighted, options.merge, budgetOf(options));
    const std::vector<int> ids = assignShaderIds(weighted, merged, options.lockedIds);
    const int count = ids.empty() ? 0 : 1 + std::ranges::max(ids);
    plan.cases.resize(static_cast<std::size_t>(count));
    for (int id = 0; id < count; ++id) {
        plan.cases[static_cast<std::size_t>(id)].shaderId = id;
    }
    for (std::size_t i = 0; i < merged.size(); ++i) {
        plan.cases[static_cast<std::size_t>(ids[i])] = makeCase(ids[i], std::move(merged[i]), plan.keys);
    }
    nameCases(plan);
}

}  // namespace

bool countsHits(const PlanOptions& options) {
    return options.merge == MergePolicy::Profile ||
           (options.merge == MergePolicy::Auto && !options.hits.empty());
}

Plan planKeys(std::span<const materials::Material> materials,
              std::span<const materials::PrimitiveInputs> primitives, const materials::KeyOptions& options) {
    Plan plan;
    if (!materials.empty()) {
        plan.model = &materials.front().model();
    }
    DroppedMap droppedBy;
    collectKeys(materials, primitives, options, plan, droppedBy);
    for (auto& [what, materialSet] : droppedBy) {
        plan.dropped.push_back({what.first, what.second, {materialSet.begin(), materialSet.end()}});
    }
    plan.records = recordUses(materials, primitives, plan);
    return plan;
}

std::vector<WeightedKey> weightedKeys(const Plan& plan, const PlanOptions& options) {
    std::vector<WeightedKey> keys;
    keys.reserve(plan.keys.size());
    for (const Key& key : plan.keys) {
        keys.push_back({key.mask, key.share, plan.model, options.branchFactor});
    }
    return keys;
}

Plan planCases(Plan plan, std::span<const materials::PrimitiveInputs> primitives, const PlanOptions& options,
               const CaseChooser& choose) {
    shareHits(primitives, options, plan.keys);
    makeCases(options, choose, plan);

    std::vector<materials::FeatureMask> hitMasks;
    for (const Key& key : plan.keys) {
        hitMasks.push_back(key.mask);
    }
    FeatureSpread hits = spreadOf(hitMasks);
    FeatureSpread primary = spreadOf(plan.primaryMaskOfPrimitive);
    if (options.fallback) {
        // Later materials may lack features that all of these have.
        hits = {0, hits.always | hits.sometimes};
        primary = {0, primary.always | primary.sometimes};
    }
    plan.always = hits.always;
    plan.sometimes = hits.sometimes;
    plan.primaryAlways = primary.always;
    plan.primarySometimes = primary.sometimes;
    addFeaturesOfEdits(plan, options.fallback, plan.records);
    plan.keysPossible = plan.keys.empty() ? 0.0 : std::exp2((hits.always | hits.sometimes).count());
    return plan;
}

Case fallbackCase(const Plan& plan) {
    Case shaderCase;
    shaderCase.shaderId = -1;
    shaderCase.name = "Fallback";
    shaderCase.sometimes = plan.always | plan.sometimes;
    return shaderCase;
}

Case firstCase(const Plan& plan, const Case& shaderCase) {
    Case first = shaderCase;
    const materials::FeatureMask ofPrimary = plan.primaryAlways | plan.primarySometimes;
    if (shaderCase.isRetired()) {
        first.always = 0;
        first.sometimes = ofPrimary;
        return first;
    }
    std::vector<materials::FeatureMask> masks;
    for (const int key : shaderCase.keys) {
        for (const int primitive : plan.keys[static_cast<std::size_t>(key)].primitives) {
            masks.push_back(plan.primaryMaskOfPrimitive[static_cast<std::size_t>(primitive)]);
        }
    }
    // The key of hits does not say whether a material that an edit chooses has these.
    const materials::FeatureMask dropped = ofPrimary & ~(plan.always | plan.sometimes);
    const FeatureSpread spread = spreadOf(masks);
    first.always = spread.always & ~dropped;
    first.sometimes = (spread.sometimes | dropped) & ~first.always;
    return first;
}

Case draftCase(const Plan& plan) {
    Case shaderCase;
    shaderCase.shaderId = -1;
    shaderCase.name = "Draft";
    for (const materials::Feature& feature : plan.model->features) {
        shaderCase.sometimes |= feature.isInDraft ? feature.mask() : materials::FeatureMask();
    }
    shaderCase.sometimes &= plan.primaryAlways | plan.primarySometimes;
    return shaderCase;
}

std::size_t caseCount(const Plan& plan) {
    return static_cast<std::size_t>(
        std::ranges::count_if(plan.cases, [](const Case& shaderCase) { return !shaderCase.isRetired(); }));
}

int budgetOf(const PlanOptions& options) {
    const bool needsOne = options.merge == MergePolicy::Auto || options.merge == MergePolicy::Profile;
    return options.maxShaders > 0 ? options.maxShaders : needsOne ? kDefaultMaxCases : 0;
}

std::optional<std::string> describeExcess(const Plan& plan, const PlanOptions& options) {
    const int maxShaders = options.maxShaders;
    if (maxShaders <= 0 || caseCount(plan) <= static_cast<std::size_t>(maxShaders)) {
        return std::nullopt;
    }
    std::set<materials::FeatureMask> families;
    for (const Key& key : plan.keys) {
        families.insert(key.mask & plan.model->lobes);
    }
    std::string advice = "raise --max-shaders";
    if (options.merge == MergePolicy::None && families.size() <= static_cast<std::size_t>(maxShaders)) {
        advice = fmt::format(
            "use --merge family, which needs {}, or --merge auto, which keeps to any limit, or {}",
            families.size(), advice);
    } else {
        advice = fmt::format("use --merge auto, which keeps to it, or {}", advice);
    }
    return fmt::format("the plan needs {} cases for {} keys; the limit is {}: {}", caseCount(plan),
                       plan.keys.size(), maxShaders, advice);
}

}  // namespace glint::compiler

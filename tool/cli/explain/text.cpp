#include "base/lists.h"
#include "cli/report.h"
#include "emit/package/manifest.h"
#include "plan/plan_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <set>
#include <utility>

namespace glint::cli {

namespace {

const compiler::Case& caseOf(const compiler::Build& build, int shaderId) {
    return build.plan.cases[static_cast<std::size_t>(shaderId)];
}

std::string titleOf(const compiler::Build& build, int shaderId, Detail detail) {
    return shaderTitle(static_cast<std::uint64_t>(shaderId), caseOf(build, shaderId).name, detail);
}

std::string percent(double share) {
    return fmt::format("{:.2f} %", 100.0 * share);
}

// Returns the first names, and how many more there are.
std::string materialsText(const compiler::Build& build, const std::vector<int>& materials) {
    const auto nameOf = [&](int material) { return build.scenes->materialName(material); };
    return base::firstOf(base::mapped<std::string>(materials, nameOf), 3, "; ");
}

std::string headText(const compiler::Build& build) {
    const int budget = budgetOf(build.settings.compile.plan);
    const std::string limit = budget > 0 ? fmt::format(", at most {}", budget) : std::string();
    return fmt::format(
        "{}: {} in {}, --merge {}{}; hits {}\n\n"
        "in vain       SPIR-V instructions that an average hit of the scene runs because its case holds "
        "more\n"
        "              than its key: branches, and code that other lanes of its subgroup wait for\n"
        "spared        {:.0f} for each case that sharing makes unnecessary\n"
        "instructions  of the case's shader; they and the fetches are estimated\n"
        "apart         instructions of shaders of its keys alone, on average over its hits\n",
        build.scenes->fileNames(), base::counted(build.plan.keys.size(), "key"),
        base::counted(caseCount(build.plan), "case"), nameOf(build.settings.compile.plan.merge), limit,
        countsHits(build.settings.compile.plan) ? "counted by the profile" : "expected from areas",
        compiler::kCaseCost);
}

// Without the columns that other tables have, too, where a line has to fit a terminal.
std::string fitting(Rows rows, Detail detail) {
    constexpr std::size_t kColumns[] = {9, 6};  // why, branches; the last first
    for (const std::size_t column : kColumns) {
        for (std::vector<std::string>& row : rows) {
            if (detail == Detail::Short) {
                row.erase(row.begin() + static_cast<std::ptrdiff_t>(column));
            }
        }
    }
    return formatTable(rows, detail);
}

std::string overviewText(const compiler::Build& build, const compiler::PlanCost& cost, Detail detail) {
    Rows rows{
        {"case", "keys", "hits", "instructions", "apart", "fetches", "branches", "in vain", "spared", "why"}};
    double saved = 0.0;
    for (const compiler::CaseCost& entry : cost.cases) {
        const compiler::Case& shaderCase = caseOf(build, entry.shaderId);
        saved += entry.saved;
        rows.push_back({titleOf(build, entry.shaderId, detail), std::to_string(shaderCase.keys.size()),
                        percent(shaderCase.share), fmt::format("{:.0f}", entry.code.instructions),
                        fmt::format("{:.0f}", entry.ownInstructions),
                        fmt::format("{:.0f}", entry.code.fetches), std::to_string(entry.branches.size()),
                        fmt::format("{:.2f}", entry.inVain), fmt::format("{:.0f}", entry.saved),
                        std::string(toString(shaderCase.reason))});
    }
    rows.push_back({"all", std::to_string(build.plan.keys.size()), "", "", "", "", "",
                    fmt::format("{:.2f}", cost.inVain), fmt::format("{:.0f}", saved), ""});
    for (std::size_t column = 2; column < 7; ++column) {
        rows.back()[column] = "-";
    }
    return fitting(std::move(rows), detail);
}

std::string nearestText(const compiler::Build& build, const compiler::NearestCase& nearest, Detail detail) {
    return fmt::format("with case {}, the nearest: {:.2f} more in vain, {:.0f} spared",
                       titleOf(build, nearest.shaderId, detail), nearest.adds, compiler::kCaseCost);
}

std::string fetchesText(const compiler::CodeEstimate& code) {
    return fmt::format("{:.0f} fetch{}", code.fetches, code.fetches == 1.0 ? "" : "es");
}

std::string leavingText(const compiler::KeyCost& cost) {
    return cost.leavingAdds < 0.0 ? fmt::format("apart it would spare {:.2f}", -cost.leavingAdds)
                                  : fmt::format("apart it would cost {:.2f} more", cost.leavingAdds);
}

// Describes a case of several keys.
std::string mergedText(const compiler::Build& build, const compiler::CaseCost& entry, Detail detail) {
    const compiler::Case& shaderCase = caseOf(build, entry.shaderId);
    Rows rows{{"  why", fmt::format("{}: {}", toString(shaderCase.reason), explain(shaderCase.reason))},
              {"  merged", fmt::format("{:.2f} in vain, {:.0f} spared ({} fewer)", entry.inVain, entry.saved,
                                       base::counted(shaderCase.keys.size() - 1, "case"))},
              {"  all have", base::join(build.plan.model->names(shaderCase.always))}};
    std::string label = "  branches on";
    for (const compiler::BranchCost& branch : entry.branches) {
        rows.push_back({label, fmt::format("{}, in {} of its hits: {:.2f}", branch.feature->name,
                                           percent(branch.share), branch.cost)});
        label.clear();
    }
    label = "  keys";
    for (const compiler::KeyCost& key : entry.keys) {
        const compiler::Key& planKey = build.plan.keys[static_cast<std::size_t>(key.key)];
        rows.push_back({label, fmt::format("{}: {} of all hits, {:.0f} instructions, {}; {}",
                                           materialsText(build, planKey.materials), percent(planKey.share),
                                           key.own.instructions, fetchesText(key.own), leavingText(key))});
        const materials::FeatureMask besides = planKey.mask & ~shaderCase.always;
        rows.push_back({"", besides != 0 ? "  with " + base::join(build.plan.model->names(besides))
                                         : "  with nothing else"});
        label.clear();
    }
    if (entry.nearest) {
        rows.push_back({"  no further", nearestText(build, *entry.nearest, detail)});
    }
    return fmt::format("case {}\n{}", titleOf(build, entry.shaderId, detail), formatFields(rows, detail));
}

// Cases of one key: what keeps each from sharing one.
std::string singlesText(const compiler::Build& build, const compiler::PlanCost& cost, Detail detail) {
    Rows rows{{"case", "nearest", "in vain", "spared", "materials"}};
    for (const compiler::CaseCost& entry : cost.cases) {
        const compiler::Case& shaderCase = caseOf(build, entry.shaderId);
        if (shaderCase.keys.size() == 1 && entry.nearest) {
            rows.push_back({titleOf(build, entry.shaderId, detail), std::to_string(entry.nearest->shaderId),
                            fmt::format("{:.2f}", std::max(0.0, entry.nearest->adds)),
                            fmt::format("{:.0f}", compiler::kCaseCost),
                            materialsText(build, shaderCase.materials)});
        }
    }
    return rows.size() == 1 ? std::string()
                            : "\nCases of one key, and what merging with the nearest case would cost\n\n" +
                                  formatTable(rows, detail);
}

std::string mergesText(const compiler::Build& build) {
    std::vector<std::string> head{"merged by", "cases", "in vain", "first hits"};
    head.insert(head.end(), build.mergedFor.begin(), build.mergedFor.end());
    head.emplace_back();
    Rows rows{std::move(head)};
    for (const compiler::MergeEstimate& merge : build.merges) {
        std::vector<std::string>& row = rows.emplace_back();
        row = {merge.name, std::to_string(merge.cases), fmt::format("{:.2f}", merge.inVain),
               fmt::format("{:.3f}", merge.firstMs)};
        for (const double ms : merge.ms) {
            row.push_back(fmt::format("{:.3f}", ms));
        }
        row.emplace_back(merge.chosen ? "auto" : "");
    }
    return "\nOther cases for the same keys; ms of first hits, and of these and rays by strategy\n\n" +
           formatTable(rows);
}

base::Json toJson(const compiler::CodeEstimate& code) {
    return {{"instructions", code.instructions},
            {"textureFetches", code.fetches},
            {"inputBranches", code.inputBranches},
            {"lobeBranches", code.lobeBranches}};
}

base::Json keyToJson(const compiler::Build& build, const compiler::KeyCost& cost) {
    const compiler::Key& key = build.plan.keys[static_cast<std::size_t>(cost.key)];
    return {{"mask", toHex(key.mask)},
            {"features", build.plan.model->names(key.mask)},
            {"materials", materialsToJson(*build.scenes, key.materials)},
            {"share", compiler::roundedShare(key.share)},
            {"own", {{"instructions", cost.own.instructions}, {"textureFetches", cost.own.fetches}}},
            {"leavingAdds", cost.leavingAdds}};
}

base::Json caseToJson(const compiler::Build& build, const compiler::CaseCost& cost) {
    const compiler::Case& shaderCase = caseOf(build, cost.shaderId);
    const auto branchToJson = [](const compiler::BranchCost& branch) -> base::Json {
        return {{"feature", branch.feature->name},
                {"share", compiler::roundedShare(branch.share)},
                {"inVain", branch.cost}};
    };
    base::Json nearest;
    if (cost.nearest) {
        nearest = base::Json{
            {"id", cost.nearest->shaderId}, {"adds", cost.nearest->adds}, {"spares", compiler::kCaseCost}};
    }
    return {{"id", cost.shaderId},
            {"name", shaderCase.name},
            {"reason", toString(shaderCase.reason)},
            {"share", compiler::roundedShare(shaderCase.share)},
            {"always", build.plan.model->names(shaderCase.always)},
            {"sometimes", build.plan.model->names(shaderCase.sometimes)},
            {"estimate", toJson(cost.code)},
            {"ownInstructions", cost.ownInstructions},
            {"inVain", cost.inVain},
            {"spared", cost.saved},
            {"branches", listOf(cost.branches, branchToJson)},
            {"keys", listOf(cost.keys, [&](const compiler::KeyCost& key) { return keyToJson(build, key); })},
            {"nearest", nearest}};
}

std::string sumOf(const compiler::StrategyEstimate& estimate,
                  std::initializer_list<compiler::CostTerm> terms) {
    double sum = 0.0;
    bool has = false;
    for (const compiler::CostTerm term : terms) {
        sum += estimate.parts[static_cast<std::size_t>(term)];
        has = has || hasTerm(estimate.strategy, term);
    }
    return has ? fmt::format("{:.3f}", sum) : "-";
}

}  // namespace

std::string planText(const compiler::Build& build, Detail detail) {
    if (build.plan.keys.empty()) {
        return "no primitives: no keys, no cases\n";
    }
    const compiler::PlanCost cost = costPlan(build.plan, build.settings.compile.plan);
    std::string text = headText(build) + "\n" + overviewText(build, cost, detail);
    for (const compiler::CaseCost& entry : cost.cases) {
        if (entry.keys.size() > 1) {
            text += "\n" + mergedText(build, entry, detail);
        }
    }
    return text + singlesText(build, cost, detail) + mergesText(build);
}

base::Json planToJson(const compiler::Build& build) {
    const compiler::PlanCost cost = costPlan(build.plan, build.settings.compile.plan);
    const auto mergeToJson = [&](const compiler::MergeEstimate& merge) -> base::Json {
        base::Json times = base::Json::object();
        for (std::size_t i = 0; i < build.mergedFor.size(); ++i) {
            times[build.mergedFor[i]] = merge.ms[i];
        }
        return {{"name", merge.name},     {"cases", merge.cases},
                {"inVain", merge.inVain}, {"firstHitsMilliseconds", merge.firstMs},
                {"milliseconds", times},  {"chosen", merge.chosen}};
    };
    const int budget = budgetOf(build.settings.compile.plan);
    return {{"maxShaders", budget > 0 ? base::Json(budget) : base::Json()},
            {"hits", countsHits(build.settings.compile.plan) ? "counted" : "expected"},
            {"keys", build.plan.keys.size()},
            {"inVain", cost.inVain},
            {"caseCost", compiler::kCaseCost},
            {"cost", compiler::totalCost(cost.inVain, cost.cases.size())},
            {"cases",
             listOf(cost.cases, [&](const compiler::CaseCost& entry) { return caseToJson(build, entry); })},
            {"merges", listOf(build.merges, mergeToJson)}};
}

std::string strategiesText(const compiler::StrategyAdvice& advice) {
    const compiler::FrameFacts& facts = advice.choice.facts;
    const std::string costs = advice.builtIn ? "as measured on " : "of the calibration of ";
    std::string text = fmt::format("\nStrategies for a frame of {:.3g} million pixels, costs {}{}\n\n",
                                   advice.pixels / 1e6, costs, advice.device);
    if (facts.rays > 0.0) {
        Rows rows{{"strategy, ms", "all", "launches", "rays", "ordering", "shading", "divergence"}};
        for (const compiler::StrategyEstimate& estimate : advice.choice.estimates) {
            rows.push_back({estimate.strategy, fmt::format("{:.3f}", estimate.ms),
                            sumOf(estimate, {compiler::CostTerm::Launches, compiler::CostTerm::Cases}),
                            sumOf(estimate, {compiler::CostTerm::Rays, compiler::CostTerm::Incoherence}),
                            sumOf(estimate, {compiler::CostTerm::Buckets}),
                            sumOf(estimate, {compiler::CostTerm::Instructions}),
                            sumOf(estimate, {compiler::CostTerm::Divergence, compiler::CostTerm::Code,
                                             compiler::CostTerm::Misses})});
        }
        text += formatTable(rows) + "\n";
    }
    return text + wrapped(fmt::format("--strategy {}: {}\n\n", advice.choice.strategy, advice.choice.why));
}

namespace {

using Drop = std::pair<std::string, std::string>;  // feature, reason

// Returns the features that a material asks for and does not get, over all of its primitives.
std::set<Drop> dropsOf(const compiler::Build& build, int material) {
    std::set<Drop> drops;
    for (const compiler::DroppedFeature& dropped : build.plan.dropped) {
        if (std::ranges::binary_search(dropped.materials, material)) {
            drops.emplace(dropped.feature, dropped.reason);
        }
    }
    return drops;
}

std::vector<const compiler::Key*> keysOf(const compiler::Build& build, int material) {
    std::vector<const compiler::Key*> keys;
    for (const compiler::Key& key : build.plan.keys) {
        if (std::binary_search(key.materials.begin(), key.materials.end(), material)) {
            keys.push_back(&key);
        }
    }
    return keys;
}

// Returns JSON pointers of the primitives of one material that have this key.
std::vector<std::string> primitivesOf(const compiler::Build& build, const compiler::Key& key, int material) {
    std::vector<std::string> pointers;
    for (const int index : key.primitives) {
        const materials::PrimitiveInputs& inputs =
            build.scenes->primitives()[static_cast<std::size_t>(index)];
        if (inputs.material == material) {
            pointers.push_back(fmt::format("/meshes/{}/primitives/{}", inputs.mesh, inputs.primitive));
        }
    }
    return pointers;
}

// Returns the masks of primary surfaces of one material whose hits have this key. If hits keep all lobes, it
// is only the key itself.
std::set<materials::FeatureMask> primaryMasksOf(const compiler::Build& build, const compiler::Key& key,
                                                int material) {
    std::set<materials::FeatureMask> masks;
    for (const int index : key.primitives) {
        const auto primitive = static_cast<std::size_t>(index);
        if (build.scenes->primitives()[primitive].material == material) {
            masks.insert(build.plan.primaryMaskOfPrimitive[primitive]);
        }
    }
    return masks;
}

base::Json primaryToJson(const compiler::Build& build, const compiler::Key& key, int material) {
    return listOf(primaryMasksOf(build, key, material),
                  [&](const materials::FeatureMask& mask) { return build.plan.model->names(mask); });
}

// The values of the material that animations or programs change: planning drops no feature for one of them.
const gltf::AnimatedMaterial& changesOf(const gltf::SceneList& scenes, int material) {
    static const gltf::AnimatedMaterial kNone;
    const gltf::SceneList::Place place = scenes.place(material);
    const std::vector<gltf::AnimatedMaterial>& all = scenes.scenes()[place.scene].animatedMaterials;
    const auto found = std::ranges::find(all, place.index, &gltf::AnimatedMaterial::material);
    return found == all.end() ? kNone : *found;
}

std::string whyText(const compiler::Case& shader) {
    const std::size_t keys = shader.keys.size();
    return fmt::format("{}: {}{}", toString(shader.reason), explain(shader.reason),
                       keys > 1 ? fmt::format(" ({} keys)", keys) : std::string());
}

std::string sharesText(const compiler::Build& build, const compiler::Key& key, const compiler::Case& shader) {
    const bool counted = countsHits(build.settings.compile.plan);
    const std::string ofCase =
        shader.keys.size() > 1 ? fmt::format(", its case {:.2f} %", 100.0 * shader.share) : std::string();
    return fmt::format("{:.2f} %{}, {}", 100.0 * key.share, ofCase,
                       counted ? "counted by the profile" : "expected from areas");
}

}  // namespace

base::Json materialToJson(const compiler::Build& build, int material) {
    const auto keyOfMaterial = [&](const compiler::Key* key) -> base::Json {
        const compiler::Case& shader = caseOf(build, key->shaderId);
        return {{"mask", toHex(key->mask)},
                {"features", build.plan.model->names(key->mask)},
                {"onPrimarySurfaces", primaryToJson(build, *key, material)},
                {"share", compiler::roundedShare(key->share)},
                {"case",
                 {{"id", shader.shaderId},
                  {"name", shader.name},
                  {"keys", shader.keys.size()},
                  {"share", compiler::roundedShare(shader.share)},
                  {"reason", toString(shader.reason)},
                  {"always", build.plan.model->names(shader.always)},
                  {"sometimes", build.plan.model->names(shader.sometimes)}}},
                {"primitives", primitivesOf(build, *key, material)}};
    };
    const auto dropToJson = [](const Drop& drop) -> base::Json {
        return {{"feature", drop.first}, {"reason", drop.second}};
    };
    return {{"index", material},
            {"name", build.scenes->materialName(material)},
            {"keys", listOf(keysOf(build, material), keyOfMaterial)},
            {"dropped", listOf(dropsOf(build, material), dropToJson)},
            {"animated", changesOf(*build.scenes, material).changes},
            {"edited", changesOf(*build.scenes, material).edited}};
}

Rows materialRows(const compiler::Build& build, int material, Detail detail) {
    Rows rows;
    for (const compiler::Key* key : keysOf(build, material)) {
        const compiler::Case& shader = caseOf(build, key->shaderId);
        rows.push_back({"  key", toHex(key->mask)});
        rows.push_back({"    features", base::join(build.plan.model->names(key->mask))});
        for (const materials::FeatureMask& mask : primaryMasksOf(build, *key, material)) {
            if (mask != key->mask) {
                rows.push_back({"    primary only", base::join(build.plan.model->names(mask & ~key->mask))});
            }
        }
        rows.push_back(
            {"    case", shaderTitle(static_cast<std::uint64_t>(shader.shaderId), shader.name, detail)});
        rows.push_back({"    why", whyText(shader)});
        rows.push_back({"    hits", sharesText(build, *key, shader)});
        rows.push_back({"    branches on", base::join(build.plan.model->names(shader.sometimes))});
        rows.push_back({"    primitives", base::firstOf(primitivesOf(build, *key, material), 1)});
    }
    if (rows.empty()) {
        return rows;
    }
    for (const auto& [feature, reason] : dropsOf(build, material)) {
        rows.push_back({"  dropped", fmt::format("{}: {}", feature, reason)});
    }
    const gltf::AnimatedMaterial& changes = changesOf(*build.scenes, material);
    for (const std::string& change : changes.changes) {
        rows.push_back({"  animated", fmt::format("{}: kept for all values between", change)});
    }
    for (const std::string& change : changes.edited) {
        rows.push_back({"  edited", fmt::format("{}: kept for all values that a program may set", change)});
    }
    return rows;
}

}  // namespace glint::cli

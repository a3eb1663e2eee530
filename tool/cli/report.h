// Output that several commands share, as JSON and as text.
#pragma once

#include "base/fields.h"
#include "cli/console.h"
#include "cli/table.h"
#include "emit/compile.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"
#include "resolve/build.h"

#include <glint/internal/frame_traffic.h>
#include <glint/internal/package_modules.h>
#include <glint/package.h>
#include <glint/result.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::cli {

// Gives the result of a command: what toJson() returns with --json, else what toText(detail) returns.
template <typename ToJson, typename ToText>
void answer(const Console& console, const ToJson& toJson, const ToText& toText) {
    if (console.isJson()) {
        console.result(toJson());
    } else {
        console.print(toText(console.isVerbose() ? Detail::Whole : Detail::Short));
    }
}

// Returns the list of what toJson(element) returns.
template <typename List, typename ToJson>
base::Json listOf(List&& list, const ToJson& toJson) {
    base::Json json = base::Json::array();
    for (const auto& element : list) {
        json.push_back(toJson(element));
    }
    return json;
}

// Returns [{"scene", "index", "name"}]; `materials` are indices into scenes.materials().
base::Json materialsToJson(const gltf::SceneList& scenes, std::span<const int> materials);
// Returns [{"feature", "reason", "materials"}].
base::Json droppedToJson(const gltf::SceneList& scenes, const compiler::Plan& plan);

// Returns one line for each feature and reason, with the number of materials. Empty if nothing was dropped.
std::string droppedText(const compiler::Plan& plan);

// Returns the case's own modules by stage, as in the manifest. Empty without a package, and for strategies
// that have none.
base::Json stagesToJson(const compiler::CompiledPackage* package, int shaderId);

// These name which of the modules of its role it is; empty if there is only one.
std::string tracerName(const package::ModuleKey& key);    // "ray-query"
std::string orderingName(const package::ModuleKey& key);  // "wave-ballot"

// --- The bytes that the passes of a frame move, as JSON and as tables ---

// The bytes that a frame moved. The rows are those of its shape.
struct TrafficReport {
    TrafficShape shape;
    TrafficCounts counts;
};
base::Fields fieldsOf(const TrafficReport*);
std::string toText(const TrafficReport& report);
// "X bytes a pixel moved".
std::string summaryOf(const TrafficReport& report);

struct StrategyTraffic {
    std::string_view strategy;
    std::vector<TrafficRow> passes;
};
base::Fields fieldsOf(const StrategyTraffic*);
// The bytes that frames of a package move for each pixel, ray and hit, by strategy.
std::vector<StrategyTraffic> trafficOf(const Package& package);
std::string trafficTable(const Package& package);

// --- The texts of glint explain: cases and their costs, strategies, materials with their keys ---

std::string planText(const compiler::Build& build, Detail detail);

// Returns the members that `explain --plan --json` adds to the plan's options: docs/cli.md lists them.
base::Json planToJson(const compiler::Build& build);

// Returns a table of milliseconds, the recommended strategy and the reason.
std::string strategiesText(const compiler::StrategyAdvice& advice);

// --- The text of glint explain about a material: its keys and cases, and why ---

// Returns rows of a label and a text. There are none if no primitive has the material.
Rows materialRows(const compiler::Build& build, int material, Detail detail);
// Returns a member of `materials` of `explain --json`: docs/cli.md lists its members.
base::Json materialToJson(const compiler::Build& build, int material);

}  // namespace glint::cli

// Output that several commands share, as JSON and as text.
#pragma once

#include "base/json.h"
#include "cli/console.h"
#include "emit/compile.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"

#include <glint/package_modules.h>
#include <glint/result.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace glint {

Json toJson(const Diagnostic& diagnostic);
Json toJson(std::span<const Diagnostic> diagnostics);
Json featuresToJson(const MaterialModel& model, FeatureMask mask);
// Returns [{"scene", "index", "name"}]; `materials` are indices into scenes.materials().
Json materialsToJson(const SceneList& scenes, std::span<const int> materials);
// Returns [{"feature", "reason", "materials"}].
Json droppedToJson(const SceneList& scenes, const Plan& plan);

// Returns the names of the features of a mask, "a, b", or "-".
std::string featureList(const MaterialModel& model, FeatureMask mask);
// Returns one line for each feature and reason, with the number of materials. Empty if nothing was dropped.
std::string droppedText(const Plan& plan);

// Returns the error "output-folder" unless `file` could be created: its folder must exist, and it must not be
// a folder itself.
Status checkOutputFile(const std::filesystem::path& file);

// bytes, instructions, textureFetches, rayQueries, branches
Json statisticsToJson(const SpirvStatistics& statistics);

// Returns the case's own modules by stage, as in the manifest. Empty without a package, and for strategies
// that have none.
Json stagesToJson(const CompiledPackage* package, int shaderId);

// These name which of the modules of its role it is; empty if there is only one.
std::string tracerName(const package::ModuleKey& key);    // "ray-query"
std::string orderingName(const package::ModuleKey& key);  // "wave-ballot"

}  // namespace glint

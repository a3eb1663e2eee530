// Output that several commands share, as JSON and as text.
#pragma once

#include "cli/console.h"
#include "emit/compile.h"
#include "emit/package/json.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"

#include <glint/package_modules.h>
#include <glint/result.h>

#include <span>
#include <string>
#include <vector>

namespace glint::cli {

base::Json featuresToJson(const materials::MaterialModel& model, materials::FeatureMask mask);
// Returns [{"scene", "index", "name"}]; `materials` are indices into scenes.materials().
base::Json materialsToJson(const gltf::SceneList& scenes, std::span<const int> materials);
// Returns [{"feature", "reason", "materials"}].
base::Json droppedToJson(const gltf::SceneList& scenes, const compiler::Plan& plan);

// Returns the names of the features of a mask, "a, b", or "-".
std::string featureList(const materials::MaterialModel& model, materials::FeatureMask mask);
// Returns one line for each feature and reason, with the number of materials. Empty if nothing was dropped.
std::string droppedText(const compiler::Plan& plan);

// Returns the case's own modules by stage, as in the manifest. Empty without a package, and for strategies
// that have none.
base::Json stagesToJson(const compiler::CompiledPackage* package, int shaderId);

// These name which of the modules of its role it is; empty if there is only one.
std::string tracerName(const package::ModuleKey& key);    // "ray-query"
std::string orderingName(const package::ModuleKey& key);  // "wave-ballot"

}  // namespace glint::cli

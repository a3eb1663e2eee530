// Output that several commands share, as JSON and as text.
#pragma once

#include "cli/console.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"

#include <glint/result.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Keys keep the order in which they are added.
using Json = nlohmann::ordered_json;

// Text that is not UTF-8 is replaced, so that the output is always valid JSON.
std::string toText(const Json& json);

Json toJson(const Diagnostic& diagnostic);
Json toJson(std::span<const Diagnostic> diagnostics);
Json featuresToJson(FeatureMask mask);
// Returns the value, or null if there is none.
template <typename T>
Json orNull(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}
// Returns the text, or null if it is empty.
Json textOrNull(const std::string& text);
// Returns [{"scene", "index", "name"}]; `materials` are indices into scenes.materials().
Json materialsToJson(const SceneList& scenes, std::span<const int> materials);
// Returns [{"feature", "reason", "materials"}].
Json droppedToJson(const SceneList& scenes, const Plan& plan);

// Returns the names of the features of a mask, "a, b", or "-".
std::string featureList(FeatureMask mask);
// Returns one line for each feature and reason, with the number of materials. Empty if nothing was dropped.
std::string droppedText(const Plan& plan);

// Returns the error "output-folder" unless `file` could be created: its folder must exist, and it must not be
// a folder itself.
Status checkOutputFile(const std::filesystem::path& file);

}  // namespace glint

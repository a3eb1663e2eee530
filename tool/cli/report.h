// What several commands say alike, as JSON and as text.
#pragma once

#include "cli/console.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"

#include <glint/result.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Keys keep the order in which they are written here.
using Json = nlohmann::ordered_json;

// Text that is not UTF-8 is replaced, so that the output is JSON whatever the input.
std::string toText(const Json& json);

Json toJson(const Diagnostic& diagnostic);
Json toJson(std::span<const Diagnostic> diagnostics);
Json featuresToJson(FeatureMask mask);
// The text, or null where it is empty.
Json textOrNull(const std::string& text);
// [{"scene", "index", "name"}]; `materials` are indices into scenes.materials().
Json materialsToJson(const SceneList& scenes, std::span<const int> materials);
// [{"feature", "reason", "materials"}]
Json droppedToJson(const SceneList& scenes, const Plan& plan);

// Names of the features of a mask, "a, b", or "-".
std::string featureList(FeatureMask mask);
// One line for each feature and reason with the number of materials; empty if nothing was dropped.
std::string droppedText(const Plan& plan);

// Error "output-folder" unless `file` could be made: its folder is there and it is no folder itself.
Status checkOutputFile(const std::filesystem::path& file);

}  // namespace glint

// What several commands say alike, as JSON and as text.
#pragma once

#include "cli/console.h"
#include "gltf/scene.h"
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
// The name, or null.
Json variantToJson(const Scene& scene);
// [{"index", "name"}]
Json materialsToJson(const Scene& scene, std::span<const int> materials);
// [{"feature", "reason", "materials"}]
Json droppedToJson(const Scene& scene, const Plan& plan);

// Names of the features of a mask, "a, b", or "-".
std::string featureList(FeatureMask mask);
// The glTF name, else "material N"; "(default)" for the material of primitives that have none.
std::string materialName(const Scene& scene, int material);

// One line for each feature and reason with the number of materials; empty if nothing was dropped.
std::string droppedText(const Plan& plan);

// Error "output-folder" unless `file` could be made: its folder is there and it is no folder itself.
Status checkOutputFile(const std::filesystem::path& file);

}  // namespace glint

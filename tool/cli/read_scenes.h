// Reads the scenes of the command line.
#pragma once

#include "gltf/import.h"

#include <glint/result.h>

#include <span>
#include <string>
#include <vector>

namespace glint {

// Reads each file with `options`. A variant is used in the scenes that have it. Has the errors of
// importScene(); "variant-unknown" only if no scene has the variant.
Result<std::vector<Scene>> readScenes(std::span<const std::string> files, const ImportOptions& options);

// Returns the warnings of all scenes.
std::vector<Diagnostic> warningsOf(std::span<const Scene> scenes);

}  // namespace glint

// Scenes from the command line.
#pragma once

#include "gltf/import.h"

#include <glint/result.h>

#include <span>
#include <string>
#include <vector>

namespace glint {

// Each file with `options`. A variant is used in the scenes that have it. Errors of importScene();
// "variant-unknown" only where no scene has the variant.
Result<std::vector<Scene>> readScenes(std::span<const std::string> files, const ImportOptions& options);

// The warnings of all.
std::vector<Diagnostic> warningsOf(std::span<const Scene> scenes);

}  // namespace glint

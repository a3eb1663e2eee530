// The output of glint explain about what moves in a scene.
#pragma once

#include "cli/report.h"
#include "gltf/scene.h"

#include <string>

namespace glint::cli {

// Describes animations, and the meshes that follow joints or morph targets.
base::Json motionToJson(const gltf::Scene& scene);
// Returns an empty text if nothing moves.
std::string motionText(const gltf::Scene& scene);

}  // namespace glint::cli

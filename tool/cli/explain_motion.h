// What of a scene moves, as glint explain says it.
#pragma once

#include "cli/report.h"
#include "gltf/scene.h"

#include <string>

namespace glint {

// Animations, and the meshes that follow joints or morph targets.
Json motionToJson(const Scene& scene);
// Empty where nothing moves.
std::string motionText(const Scene& scene);

}  // namespace glint

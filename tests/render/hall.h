// A scene whose hits and shadow rays meet several materials, masks and lights.
#pragma once

#include "gltf/scene.h"

namespace glint::testing {

// Returns a mirror floor in front of a wall of several materials, behind a fence with holes. Instances have
// several geometries, so that the records of a shader binding table matter. Nothing touches: at a seam the
// last bit of a point would decide whether it is in shadow. The fence shades cases without textures.
gltf::Scene hallScene();

}  // namespace glint::testing

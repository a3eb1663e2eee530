// A scene whose hits and shadow rays meet several materials, masks and lights.
#pragma once

#include "gltf/scene.h"

namespace glint::testing {

// A mirror floor before a wall of several materials, behind a fence with holes; instances of several
// geometries, so that the records of a shader binding table count. Nothing touches: at a seam the last bit of
// a point decides whether it is in the shadow. Cases without textures have the fence in their light.
Scene hallScene();

}  // namespace glint::testing

// Scenes whose reflections show many materials, for comparisons of whole pictures.
#pragma once

#include "gltf/scene.h"

namespace glint::testing {

// A floor of brushed metal before walls of eight materials, most with lobes of their own, under a sun and two
// lamps.
Scene roomOfMaterials();

// A mirror beside a fence with alpha masks, a mirrored instance and a wall of glass, under a lamp.
Scene roomWithFence();

}  // namespace glint::testing

// Scenes whose reflections show many materials, for comparisons of whole pictures.
#pragma once

#include "gltf/scene.h"

namespace glint::testing {

// Returns a floor of metal in front of walls of eight materials, most of which have lobes of their own, under
// a sun and two lamps.
gltf::Scene roomOfMaterials();

// Returns the same in the nightly run, else the room without sheen, anisotropy and iridescence, whose code
// takes much of the time that the room takes to compile. For tests of what does not depend on lobes:
// test_combinations has all lobes with each strategy, tracer and merge policy by day, too.
gltf::Scene roomOfFewMaterials();

// Returns that second room behind a pane of thin glass, which is the last material and passes most light.
gltf::Scene roomBehindPane();

// Returns a mirror beside a fence with alpha masks, a mirrored instance and a wall of glass, under a lamp.
gltf::Scene roomWithFence();

}  // namespace glint::testing

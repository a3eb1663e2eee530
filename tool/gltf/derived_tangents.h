// Finds tangents that say no more than the coordinates of textures do.
#pragma once

#include "gltf/scene.h"

namespace glint::gltf {

// Returns whether the primitive has tangents, and on each triangle these are, within 2.5e-7, the direction of
// U that tangentFrame() derives without them (shaders/hit/texture.glsl), with the same handedness, for each
// UV set of the primitive. Then interpolated tangents agree, too. Triangles without area do not count,
// because nothing hits them. False for primitives that skins or morph targets deform, whose tangents go other
// ways.
bool derivesTangents(const Primitive& primitive);

}  // namespace glint::gltf

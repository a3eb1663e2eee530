// Changes a scene by what its textures hold.
#pragma once

#include "gltf/scene.h"

namespace glint::gltf {

// Lets textures whose images have equal texels show one of them (Image::sameAs). Materials then name one
// texture where they named several with equal samplers. Images keep their numbers.
void mergeSameTextures(Scene& scene);

// Multiplies a texture into the parameters that it scales, and empties the slot (TextureInfo::isFolded), if
// all primitives of the material see the same constant in every channel that shading reads, and it does
// nothing but scale. Materials that an animation changes stay as they are, because the animation sets the
// factors. A texture that is 1 is left to the reason that says so.
void foldConstantTextures(Scene& scene);

// Returns whether the primitive has tangents, and on each triangle these are, within 2.5e-7, the direction of
// U that tangentFrame() derives without them (shaders/hit/texture.glsl), with the same handedness, for each
// UV set of the primitive. Then interpolated tangents agree, too. Triangles without area do not count,
// because nothing hits them. False for primitives that skins or morph targets deform, whose tangents go other
// ways.
bool derivesTangents(const Primitive& primitive);

}  // namespace glint::gltf

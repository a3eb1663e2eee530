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

}  // namespace glint::gltf

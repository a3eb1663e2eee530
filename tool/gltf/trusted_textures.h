// Finds what the textures of a scene hold where its primitives show them, and changes the scene by it.
#pragma once

#include "gltf/import_options.h"
#include "gltf/scene.h"

#include <glint/result.h>

namespace glint::gltf {

// Fills TextureInfo::content of all materials and Primitive::seen, and Image::sameAs. The scene must be
// complete, and its images need pixels or files. Images are read on all cores, those that
// ImportOptions::memo knows excepted. An image that can't be read may hold anything, and Scene::warnings gets
// a note. If pixels or files were asked for, it is an error "image-decode".
//
// The content of a texture is that of all its texels. A primitive sees less of it where its coordinates reach
// only a part (gltf/texels/texel_bounds.h). That is looked up only for channels on which a declared condition
// depends, and which are not the same all over the image. Where a pack changes coordinates, or an animation
// does, everything can be seen.
Status readTextureContent(const ImportOptions& options, Scene& scene);

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

// Finds what the textures of a scene hold where its primitives show them.
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

}  // namespace glint::gltf

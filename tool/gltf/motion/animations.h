// Imports animations: samplers, and the channels that they drive.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

namespace glint::gltf {

// Fills scene.animations, with one entry for each animation of the file, and everything that planning must
// know about the changes. Call it after importing materials, nodes, meshes and morph weights. A channel that
// can't be played is left out with a warning, because a picture at rest does not need it:
// "animation-channel", "animation-keyframes", "animation-pointer". The last one is a note if Glint has no
// such data.
void importAnimations(Document& document, Scene& scene);

}  // namespace glint::gltf

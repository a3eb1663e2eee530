// Animations: samplers and the channels that they drive.
#pragma once

#include "gltf/document.h"
#include "gltf/scene.h"

namespace glint::gltf {

// Fills scene.animations, one for each animation of the file, and all that planning has to know of what they
// change, after materials, nodes, meshes and morph weights. What can't be played is left out with a warning,
// as a picture at rest needs none of it: "animation-channel", "animation-keyframes", "animation-pointer" (a
// note where Glint has no such data).
void importAnimations(Document& document, Scene& scene);

}  // namespace glint::gltf

// Animations: samplers and the channels that they drive.
#pragma once

#include "gltf/document.h"
#include "gltf/scene.h"

namespace glint::gltf {

// Fills scene.animations, one for each animation of the file, after nodes, meshes and morph weights. What
// can't be played is left out with a warning, as a picture at rest needs none of it: "animation-channel",
// "animation-keyframes", "animation-pointer".
void importAnimations(Document& document, Scene& scene);

}  // namespace glint::gltf

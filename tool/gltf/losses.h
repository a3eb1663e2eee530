// Warns of what the file asks for and a picture can't show.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

namespace glint::gltf {

// Warns if no node draws a triangle, and says why: "nothing-drawn". Meshes and animations must have been
// imported.
void warnOfNothingDrawn(Document& document, const Scene& scene);

// Warns of each texture and lobe that a material asks for and a drawn primitive lacks the input of:
// "input-missing".
void warnOfMissingInputs(Document& document, const Scene& scene);

}  // namespace glint::gltf

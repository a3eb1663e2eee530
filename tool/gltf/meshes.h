// Imports meshes: attributes, indices, modes.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <vector>

namespace glint::gltf {

// Fills scene.meshes with one entry for each mesh of the file. `placed` says for each mesh whether a node
// draws it. A mesh that no node draws and that can't be read causes a warning and stays empty. Primitives
// without a material get material `scene.materials.size()`.
Status importMeshes(Document& document, const std::vector<bool>& placed, Scene& scene);

// Adds the differences of morph targets to the colours of vertices, by the weights at rest, and clamps the
// colours (glTF 2.0, sections 3.7.2.1 and 3.7.2.2). Call it after importing weights and animations. The
// warning "morph-attribute" says that the weights do not stay as they are.
void settleColors(Document& document, Scene& scene);

}  // namespace glint::gltf

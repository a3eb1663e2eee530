// Meshes: attributes, indices, modes.
#pragma once

#include "gltf/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <vector>

namespace glint::gltf {

// Fills scene.meshes, one for each mesh of the file; `placed` says by mesh whether a node draws it. A mesh
// that no node draws and that can't be read is a warning, and left empty. Primitives without a material get
// material `scene.materials.size()`; returns whether there are any.
Result<bool> importMeshes(Document& document, const std::vector<bool>& placed, Scene& scene);

}  // namespace glint::gltf

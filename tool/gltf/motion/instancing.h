// Imports EXT_mesh_gpu_instancing: many placements of the mesh of one node.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

namespace glint::gltf {

// Fills scene.instancings and Node::instancing. Call it after importing meshes and skins. A note
// ("node-instances") names attributes that Glint does not use. Errors: "attribute-type", "attribute-count",
// "node-transform", and those of accessors.
Status importInstances(Document& document, Scene& scene);

}  // namespace glint::gltf

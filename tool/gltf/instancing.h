// EXT_mesh_gpu_instancing: many placements of the mesh of one node.
#pragma once

#include "gltf/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

namespace glint::gltf {

// Fills scene.instancings and Node::instancing, after meshes and skins. Attributes that Glint has no use for
// are noted ("node-instances"). Errors: those of accessors; "attribute-type", "attribute-count",
// "node-transform".
Status importInstances(Document& document, Scene& scene);

}  // namespace glint::gltf

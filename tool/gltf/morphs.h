// Morph targets and their weights.
#pragma once

#include "gltf/attributes.h"
#include "gltf/scene.h"

#include <glint/result.h>

namespace glint::gltf {

// Fills primitive.targets, after its attributes. Differences to an attribute that the primitive lacks are
// left out, as glTF asks for the attribute (warning "morph-attribute").
// Errors: "attribute-count", "attribute-type", and those of accessors.
Status readTargets(const PrimitiveSource& source, Primitive& primitive);

// Fills Mesh::weights and Node::weights, after nodes and meshes; warns "morph-weights" where their number is
// not that of the mesh's targets. Error "morph-limit": each node has weights of its own, so that a small file
// can ask for the product of its nodes and its targets.
Status importMorphWeights(Document& document, Scene& scene);

}  // namespace glint::gltf

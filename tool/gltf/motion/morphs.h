// Imports morph targets and their weights.
#pragma once

#include "gltf/attributes.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <cstddef>

namespace glint::gltf {

// Warns ("morph-targets") of primitives of a mesh with different numbers of targets, as the file has them.
void compareTargets(Document& document, std::size_t mesh);

// Fills primitive.targets. Call it after reading the primitive's attributes. Differences to an attribute that
// the primitive lacks, or that Glint does not morph, are left out (warning "morph-attribute"). Errors:
// "attribute-count", "attribute-type", and those of accessors.
Status readTargets(const PrimitiveSource& source, Primitive& primitive);

// Fills Mesh::weights and Node::weights. Call it after importing nodes and meshes. The warning
// "morph-weights" says that a list has another number of weights than the mesh has targets. The error
// "morph-limit" exists because each node has weights of its own, so a small file can demand the product of
// its nodes and its targets.
Status importMorphWeights(Document& document, Scene& scene);

}  // namespace glint::gltf

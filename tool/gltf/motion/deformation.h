// Imports what deforms meshes: morph targets with their weights, and skins with the influences of joints.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <cstddef>
#include <string>
#include <vector>

namespace glint::gltf {

// Warns ("morph-targets") of primitives of a mesh with different numbers of targets, as the file has them.
void compareTargets(Document& document, std::size_t mesh);

// Fills primitive.targets. Call it after reading the primitive's attributes. Differences to an attribute that
// the primitive lacks, or that Glint does not morph, are left out (warning "morph-attribute"). Errors:
// "attribute-count", "attribute-type", and those of accessors.
Status readTargets(Document& document, const tinygltf::Primitive& file, Primitive& primitive);

// Fills Mesh::weights and Node::weights. Call it after importing nodes and meshes. The warning
// "morph-weights" says that a list has another number of weights than the mesh has targets. The error
// "morph-limit" exists because each node has weights of its own, so a small file can demand the product of
// its nodes and its targets.
Status importMorphWeights(Document& document, Scene& scene);

// The attributes JOINTS_n and WEIGHTS_n as stored, with four numbers for each vertex.
struct InfluenceSet {
    std::vector<Float4> joints;
    std::vector<Float4> weights;
};

// Joins the sets, drops influences that no vertex needs, and makes each vertex's weights sum to 1. The
// warning is "skin-weights" if they are off by more than rounding. `pointer` is that of the primitive.
SkinInfluences joinInfluences(Document& document, const std::string& pointer,
                              const std::vector<InfluenceSet>& sets);

// Fills scene.skins with the skins that nodes of the scene use, and fills Node::skin. Call it after importing
// nodes and meshes. A skin with a joint outside the scene is left out (warning "skin-joint-outside"). Errors:
// "skin-joint-range", "skin-matrices", "skin-joints".
Status importSkins(Document& document, Scene& scene);

}  // namespace glint::gltf

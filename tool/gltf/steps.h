// The steps of an import, in their order. Each reads a part of the document into the scene.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace glint::gltf {

// ---- What steps share ----

// Returns the file's node from which a node of the scene was read.
inline const tinygltf::Node& fileNode(const Document& document, const Node& node) {
    return document.model().nodes[static_cast<std::size_t>(node.source)];
}

class NodeNumbers {
public:
    NodeNumbers(const Document& document, const Scene& scene) : byFile_(document.model().nodes.size(), -1) {
        for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
            byFile_[static_cast<std::size_t>(scene.nodes[i].source)] = static_cast<int>(i);
        }
    }
    // Returns an index into Scene::nodes, or -1 if the node is not in the scene. `inFile` must be in range.
    int inScene(int inFile) const {
        return byFile_[static_cast<std::size_t>(inFile)];
    }

private:
    std::vector<int> byFile_;
};

// Calls visit(node) for nodes of the file, and for the nodes below those for which it returns true.
template <typename Nodes, typename Visit>
void visitTrees(const Document& document, const Nodes& tops, const Visit& visit) {
    std::vector<std::size_t> open(tops.begin(), tops.end());
    while (!open.empty()) {
        const std::size_t node = open.back();
        open.pop_back();
        if (visit(node)) {
            const std::vector<int>& children = document.model().nodes[node].children;
            open.insert(open.end(), children.begin(), children.end());
        }
    }
}

// ---- Materials (materials.cpp) ----

// Fills materials, textures, samplers and images of the scene. Factors out of range are clamped with a
// warning.
Status importMaterials(Document& document, Scene& scene);

// Fills Scene::variants (KHR_materials_variants). Primitives get the materials of ImportOptions::variant if
// they have one for it. Call it after importing meshes. The error is "variant-unknown".
Status applyVariant(Document& document, Scene& scene);

// ---- Nodes (motion/nodes.cpp) ----

// Chooses the scene by ImportOptions::scene, and fills its nodes, cameras and lights. Errors: "node-cycle",
// "node-parents" (a node with two parents), "node-transform", "camera-range", "scene-unknown".
Status importNodes(Document& document, Scene& scene);

// ---- Meshes (meshes.cpp) ----

// Fills scene.meshes with one entry for each mesh of the file. `placed` says for each mesh whether a node
// draws it. A mesh that no node draws and that can't be read causes a warning and stays empty. Primitives
// without a material get material `scene.materials.size()`.
Status importMeshes(Document& document, const std::vector<bool>& placed, Scene& scene);

// Adds the differences of morph targets to the colours of vertices, by the weights at rest, and clamps the
// colours (glTF 2.0, sections 3.7.2.1 and 3.7.2.2). Call it after importing weights and animations. The
// warning "morph-attribute" says that the weights do not stay as they are.
void settleColors(Document& document, Scene& scene);

// Fills the attribute arrays of `primitive`, whose pointer is set. The values are those of the file, before
// repairs. Returns the order in which the primitive's mode uses the vertices; each index is below the number
// of positions. Sets `isList` if that order is a triangle list whatever the mode is. Requires POSITION
// (attributes.cpp).
Result<std::vector<std::uint32_t>> readVertices(Document& document, const tinygltf::Primitive& file,
                                                Primitive& primitive, bool& isList);

// ---- Morph targets and skins (motion/deformation.cpp) ----

// Warns ("morph-targets") of primitives of a mesh with different numbers of targets, as the file has them.
void compareTargets(Document& document, std::size_t mesh);

// Fills primitive.targets. Call it after reading the primitive's attributes. Differences to an attribute that
// the primitive lacks, or that Glint does not morph, are left out (warning "morph-attribute"). Errors:
// "attribute-count", "attribute-type", and those of accessors.
Status readTargets(Document& document, const tinygltf::Primitive& file, Primitive& primitive);

// The attributes JOINTS_n and WEIGHTS_n as stored, with four numbers for each vertex.
struct InfluenceSet {
    std::vector<Float4> joints;
    std::vector<Float4> weights;
};

// Joins the sets, drops influences that no vertex needs, and makes each vertex's weights sum to 1. The
// warning is "skin-weights" if they are off by more than rounding. `pointer` is that of the primitive.
SkinInfluences joinInfluences(Document& document, const std::string& pointer,
                              const std::vector<InfluenceSet>& sets);

// Fills Mesh::weights and Node::weights. Call it after importing nodes and meshes. The warning
// "morph-weights" says that a list has another number of weights than the mesh has targets. The error
// "morph-limit" exists because each node has weights of its own, so a small file can demand the product of
// its nodes and its targets.
Status importMorphWeights(Document& document, Scene& scene);

// Fills scene.skins with the skins that nodes of the scene use, and fills Node::skin. Call it after importing
// nodes and meshes. A skin with a joint outside the scene is left out (warning "skin-joint-outside"). Errors:
// "skin-joint-range", "skin-matrices", "skin-joints".
Status importSkins(Document& document, Scene& scene);

// ---- Instances (motion/deformation.cpp) ----

// Fills scene.instancings and Node::instancing (EXT_mesh_gpu_instancing). Call it after importing meshes and
// skins. A note ("node-instances") names attributes that Glint does not use. Errors: "attribute-type",
// "attribute-count", "node-transform", and those of accessors.
Status importInstances(Document& document, Scene& scene);

// ---- Animations (motion/animations.cpp) ----

// Fills scene.animations, with one entry for each animation of the file, and everything that planning must
// know about the changes. Call it after importing materials, nodes, meshes and morph weights. A channel that
// can't be played is left out with a warning, because a picture at rest does not need it:
// "animation-channel", "animation-keyframes", "animation-pointer". The last one is a note if Glint has no
// such data.
void importAnimations(Document& document, Scene& scene);

}  // namespace glint::gltf

// Imports the node hierarchy of one of the file's scenes, and the cameras and lights that it places.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <vector>

namespace glint::gltf {

// Chooses the scene by ImportOptions::scene, and fills its nodes, cameras and lights. Errors: "node-cycle",
// "node-parents" (a node with two parents), "node-transform", "camera-range", "scene-unknown".
Status importNodes(Document& document, Scene& scene);

// These import a camera or light of the file and place it. They are part of importNodes().
Result<Camera> importCamera(Document& document, int camera, const Matrix4& world);
Result<Light> importLight(Document& document, int light, const Matrix4& world);

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

}  // namespace glint::gltf

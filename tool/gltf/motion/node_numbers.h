// Maps a node's number in the file to its place in the scene.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <vector>

namespace glint::gltf {

class NodeNumbers {
public:
    NodeNumbers(const Document& document, const Scene& scene)
        : byFile_(arrayMember(document.json(), "nodes").size(), -1) {
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

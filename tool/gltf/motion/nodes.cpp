#include "gltf/motion/nodes.h"

#include "base/vectors.h"
#include "gltf/motion/transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace glint::gltf {

namespace {

constexpr const char* kExportNodes = "export the scene again";

std::string pointerOf(std::size_t node) {
    return fmt::format("/nodes/{}", node);
}

// Returns the parent of each node, which is -1 for roots.
Result<std::vector<int>> findParents(const Document& document) {
    const Json& nodes = arrayMember(document.json(), "nodes");
    std::vector<int> parents(nodes.size(), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (const Json& index : arrayMember(nodes[i], "children")) {
            const int child = index.get<int>();
            int& parent = parents[static_cast<std::size_t>(child)];
            if (parent >= 0) {
                return document.error("node-parents", pointerOf(static_cast<std::size_t>(child)),
                                      fmt::format("is a child of /nodes/{} and /nodes/{}", parent, i),
                                      kExportNodes);
            }
            parent = static_cast<int>(i);
        }
    }
    return parents;
}

// Every node has at most one parent, so a node that no root reaches is on a cycle or below one.
Status checkCycles(const Document& document, const std::vector<int>& parents) {
    std::vector<bool> reached(parents.size());
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < parents.size(); ++i) {
        if (parents[i] < 0) {
            open.push_back(i);
        }
    }
    while (!open.empty()) {
        const std::size_t node = open.back();
        open.pop_back();
        reached[node] = true;
        for (const Json& child : arrayMember(document.json()["nodes"][node], "children")) {
            open.push_back(child.get<std::size_t>());
        }
    }
    const auto missed = std::find(reached.begin(), reached.end(), false);
    if (missed != reached.end()) {
        return document.error("node-cycle", pointerOf(static_cast<std::size_t>(missed - reached.begin())),
                              "is its own ancestor, or a descendant of such a node", kExportNodes);
    }
    return okStatus();
}

// Returns the nodes at which the default scene starts, in the file's order.
std::vector<std::size_t> findRoots(Document& document, const std::vector<int>& parents) {
    const Json& scenes = arrayMember(document.json(), "scenes");
    std::vector<std::size_t> roots;
    if (scenes.empty()) {
        for (std::size_t i = 0; i < parents.size(); ++i) {
            if (parents[i] < 0) {
                roots.push_back(i);
            }
        }
        return roots;
    }
    const std::uint64_t scene = sizeMember(document.json(), "scene");
    const Json& nodes = arrayMember(scenes[scene], "nodes");
    std::vector<bool> listed(parents.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto node = nodes[i].get<std::size_t>();
        const std::string pointer = fmt::format("/scenes/{}/nodes/{}", scene, i);
        if (listed[node]) {
            document.warn("scene-node-repeated", pointer, "names a node that the scene has already",
                          kExportNodes);
        } else if (parents[node] >= 0) {
            document.warn(
                "scene-node-child", pointer,
                fmt::format("names a child of /nodes/{}; it is drawn only below that", parents[node]),
                kExportNodes);
        } else {
            roots.push_back(node);
        }
        listed[node] = true;
    }
    return roots;
}

std::array<double, 4> readRotation(Document& document, const std::vector<double>& values,
                                   const std::string& pointer) {
    if (values.size() != 4) {
        return {0, 0, 0, 1};
    }
    double length = 0.0;
    for (const double value : values) {
        length = std::hypot(length, value);
    }
    // The rounding of quaternions to 16-bit integers causes a smaller error.
    constexpr double kTolerance = 1e-3;
    if (std::abs(length - 1.0) > kTolerance) {
        document.warn("node-rotation", pointer + "/rotation",
                      fmt::format("is no unit quaternion (length {}); {} is used", length,
                                  length > 0.0 ? "its direction" : "no rotation"),
                      kExportNodes);
    }
    if (length <= 0.0) {
        return {0, 0, 0, 1};
    }
    return {values[0] / length, values[1] / length, values[2] / length, values[3] / length};
}

// Whether axes that the matrix turns are no longer at right angles to each other.
bool shears(const Matrix4& matrix) {
    // Rounding a matrix to floats causes a smaller error.
    constexpr double kTolerance = 1e-3;
    const auto axis = [&](std::size_t i) {
        return glm::dvec3(matrix[4 * i], matrix[4 * i + 1], matrix[4 * i + 2]);
    };
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 a = axis(i);
        const glm::dvec3 b = axis((i + 1) % 3);
        if (std::abs(glm::dot(a, b)) > kTolerance * glm::length(a) * glm::length(b)) {
            return true;
        }
    }
    return false;
}

Matrix4 readMatrix(Document& document, const Json& json, const std::string& pointer) {
    if (json.contains("translation") || json.contains("rotation") || json.contains("scale")) {
        document.warn("node-matrix", pointer, "has a matrix and another transform; the matrix is used",
                      kExportNodes);
    }
    Matrix4 matrix{};
    std::ranges::copy(numbersMember(json, "matrix"), matrix.begin());
    if (matrix[3] != 0.0 || matrix[7] != 0.0 || matrix[11] != 0.0 || matrix[15] != 1.0) {
        document.warn("node-matrix", pointer + "/matrix",
                      "its last row is not 0 0 0 1, which glTF asks for, and is ignored", kExportNodes);
        matrix[3] = matrix[7] = matrix[11] = 0.0;
        matrix[15] = 1.0;
    }
    if (shears(matrix)) {
        document.warn("node-matrix", pointer + "/matrix",
                      "is no product of a translation, a rotation and a scale, because it shears; it is used "
                      "as it is",
                      kExportNodes);
    }
    return matrix;
}

// Reads the node's local transform into `node`, and returns it as a matrix.
Matrix4 readTransform(Document& document, std::size_t index, Node& placed) {
    const Json& json = document.json()["nodes"][index];
    const std::string pointer = pointerOf(index);
    if (json.contains("matrix")) {
        placed.matrix = readMatrix(document, json, pointer);
        return *placed.matrix;
    }
    const auto triple = [&](const char* name, double fallback) {
        const std::vector<double> values = numbersMember(json, name);
        return values.size() == 3 ? std::array{values[0], values[1], values[2]}
                                  : std::array{fallback, fallback, fallback};
    };
    placed.rest = {triple("translation", 0.0),
                   readRotation(document, numbersMember(json, "rotation"), pointer), triple("scale", 1.0)};
    return compose(placed.rest);
}

Status placeCamera(Document& document, int camera, Node& node, Scene& scene) {
    Result<Camera> placed = importCamera(document, camera, node.world);
    if (!placed) {
        return placed.error();
    }
    node.camera = static_cast<int>(scene.cameras.size());
    placed->source = camera;
    scene.cameras.push_back(std::move(*placed));
    return okStatus();
}

Status placeLight(Document& document, int light, Node& node, Scene& scene) {
    Result<Light> placed = importLight(document, light, node.world);
    if (!placed) {
        return placed.error();
    }
    node.light = static_cast<int>(scene.lights.size());
    placed->source = light;
    scene.lights.push_back(std::move(*placed));
    return okStatus();
}

Status appendNode(Document& document, std::size_t index, int parent, Scene& scene) {
    const Json& json = document.json()["nodes"][index];
    Node node;
    node.name = textMember(json, "name");
    node.parent = parent;
    node.mesh = indexMember(json, "mesh");
    node.source = static_cast<int>(index);
    const Matrix4 above = parent < 0 ? identity() : scene.nodes[static_cast<std::size_t>(parent)].world;
    node.world = multiply(above, readTransform(document, index, node));
    if (!fitsFloat(node.world)) {
        return document.error("node-transform", pointerOf(index), "its transform in the world overflows",
                              "check the scales of the node and its parents");
    }
    if (const Json* const visibility = findExtension(json, "KHR_node_visibility")) {
        node.visible = boolMember(*visibility, "visible", true);
    }
    if (const int camera = indexMember(json, "camera"); camera >= 0) {
        if (Status status = placeCamera(document, camera, node, scene); !status) {
            return status;
        }
    }
    if (const Json* light = findExtension(json, "KHR_lights_punctual")) {
        if (Status status = placeLight(document, (*light)["light"].get<int>(), node, scene); !status) {
            return status;
        }
    }
    scene.nodes.push_back(std::move(node));
    return okStatus();
}

}  // namespace

Status importNodes(Document& document, Scene& scene) {
    const Result<std::vector<int>> parents = findParents(document);
    if (!parents) {
        return parents.error();
    }
    if (Status status = checkCycles(document, *parents); !status) {
        return status;
    }
    // Nodes are visited depth first, and children in the file's order. The last one on the stack is next.
    struct Pending {
        std::size_t node;
        int parent;  // index into scene.nodes
    };
    std::vector<Pending> pending;
    const std::vector<std::size_t> roots = findRoots(document, *parents);
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) {
        pending.push_back({*root, -1});
    }
    while (!pending.empty()) {
        const Pending next = pending.back();
        pending.pop_back();
        const int parent = static_cast<int>(scene.nodes.size());
        if (Status status = appendNode(document, next.node, next.parent, scene); !status) {
            return status;
        }
        const Json& children = arrayMember(document.json()["nodes"][next.node], "children");
        for (std::size_t i = children.size(); i-- > 0;) {
            pending.push_back({children[i].get<std::size_t>(), parent});
        }
    }
    return okStatus();
}

}  // namespace glint::gltf

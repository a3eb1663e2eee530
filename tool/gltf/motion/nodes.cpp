#include "gltf/motion/nodes.h"

#include "base/suggest.h"
#include "base/vectors.h"
#include "gltf/motion/transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
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

Diagnostic unknownScene(const Document& document, const Scene& scene) {
    const std::string& wanted = document.options().scene;
    if (scene.scenesInFile.empty()) {
        return document.error(
            "scene-unknown", "",
            fmt::format("has no scene \"{}\": it has no scenes, and all its nodes are drawn", wanted),
            "leave --scene out");
    }
    std::vector<std::string> labels;
    for (std::size_t i = 0; i < scene.scenesInFile.size(); ++i) {
        labels.push_back(sceneLabel(scene, i));
    }
    return document.error("scene-unknown", "/scenes",
                          fmt::format("has no scene \"{}\"{}{}", wanted, base::enumeration(labels),
                                      base::suggestion(wanted, scene.scenesInFile)),
                          "use --scene with a name, or a number from 0");
}

// Decides which of the file's scenes is read, and lists them all.
Status chooseScene(Document& document, Scene& scene) {
    const Json& scenes = arrayMember(document.json(), "scenes");
    for (const Json& json : scenes) {
        scene.scenesInFile.push_back(textMember(json, "name"));
    }
    const std::string& wanted = document.options().scene;
    const auto count = static_cast<int>(scenes.size());
    if (wanted.empty()) {
        scene.sceneInFile = count > 0 ? integerMember(document.json(), "scene", 0) : -1;
        if (count > 1 && find(document.json(), "scene") == nullptr) {
            document.note("scene-choice", "/scenes",
                          fmt::format("the file names none of its {} scenes as the default; scene {} is read",
                                      count, sceneLabel(scene, 0)),
                          "choose another by --scene");
        }
        return okStatus();
    }
    const char* const end = wanted.data() + wanted.size();
    const auto parsed = std::from_chars(wanted.data(), end, scene.sceneInFile);
    if (parsed.ec == std::errc() && parsed.ptr == end && scene.sceneInFile >= 0 &&
        scene.sceneInFile < count) {
        return okStatus();
    }
    const auto named = std::ranges::find(scene.scenesInFile, wanted);
    if (named == scene.scenesInFile.end()) {
        return unknownScene(document, scene);
    }
    scene.sceneInFile = static_cast<int>(named - scene.scenesInFile.begin());
    return okStatus();
}

// How much of a node of the file the scene has.
enum class Part : std::uint8_t {
    None,
    Transform,  // of an ancestor that the scene does not have: it only places what is below it
    Whole
};

struct Extent {
    std::vector<Part> parts;         // by number in the file
    std::vector<std::size_t> roots;  // nodes without a parent, from which all parts are reached, in order
};

void takeTree(const Document& document, std::size_t top, std::vector<Part>& parts) {
    std::vector<std::size_t> open{top};
    while (!open.empty()) {
        const std::size_t node = open.back();
        open.pop_back();
        if (parts[node] == Part::Whole) {
            continue;  // and so is everything below it
        }
        parts[node] = Part::Whole;
        for (const Json& child : arrayMember(document.json()["nodes"][node], "children")) {
            open.push_back(child.get<std::size_t>());
        }
    }
}

// Warns of what a scene may not list, and returns the other nodes in the file's order.
std::vector<std::size_t> listedNodes(Document& document, int scene, std::size_t count) {
    std::vector<std::size_t> nodes;
    std::vector<bool> known(count);
    const Json& list = arrayMember(document.json()["scenes"][static_cast<std::size_t>(scene)], "nodes");
    for (std::size_t i = 0; i < list.size(); ++i) {
        const auto node = list[i].get<std::size_t>();
        if (known[node]) {
            document.warn("scene-node-repeated", fmt::format("/scenes/{}/nodes/{}", scene, i),
                          "names a node that the scene has already", kExportNodes);
            continue;
        }
        known[node] = true;
        nodes.push_back(node);
    }
    return nodes;
}

// Takes along the nodes above a listed one, up to those that were taken before.
void takeAncestors(std::size_t node, const std::vector<int>& parents, Extent& extent) {
    std::size_t top = node;
    bool isNew = true;
    while (isNew && parents[top] >= 0) {
        top = static_cast<std::size_t>(parents[top]);
        isNew = extent.parts[top] == Part::None;
        extent.parts[top] = isNew ? Part::Transform : extent.parts[top];
    }
    if (isNew) {
        extent.roots.push_back(top);
    }
}

// A scene should list roots. A listed node that has a parent keeps the global transform that glTF gives it,
// so the nodes above it are taken along for their transforms.
Extent extentOf(Document& document, int scene, const std::vector<int>& parents) {
    Extent extent{std::vector<Part>(parents.size(), Part::None), {}};
    std::vector<std::size_t> listed;
    if (scene < 0) {
        for (std::size_t i = 0; i < parents.size(); ++i) {
            if (parents[i] < 0) {
                listed.push_back(i);
            }
        }
    } else {
        listed = listedNodes(document, scene, parents.size());
    }
    for (const std::size_t node : listed) {
        takeTree(document, node, extent.parts);
    }
    for (const std::size_t node : listed) {
        const int parent = parents[node];
        if (parent >= 0) {
            const bool isBelow = extent.parts[static_cast<std::size_t>(parent)] == Part::Whole;
            document.warn(
                "scene-node-child", fmt::format("/scenes/{}/nodes", scene),
                fmt::format("names /nodes/{}, a child of /nodes/{}, which the scene {}", node, parent,
                            isBelow ? "has, too; it is drawn once"
                                    : "does not have; it is drawn with the transforms of the nodes above it"),
                "list the root of the tree");
        }
        takeAncestors(node, parents, extent);
    }
    return extent;
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
    GLINT_TRY(auto placed, importCamera(document, camera, node.world));
    node.camera = static_cast<int>(scene.cameras.size());
    placed.source = camera;
    scene.cameras.push_back(std::move(placed));
    return okStatus();
}

Status placeLight(Document& document, int light, Node& node, Scene& scene) {
    GLINT_TRY(auto placed, importLight(document, light, node.world));
    node.light = static_cast<int>(scene.lights.size());
    placed.source = light;
    scene.lights.push_back(std::move(placed));
    return okStatus();
}

Status appendNode(Document& document, std::size_t index, Part part, int parent, Scene& scene) {
    const Json& json = document.json()["nodes"][index];
    Node node;
    node.name = textMember(json, "name");
    node.parent = parent;
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
    if (part == Part::Transform) {
        scene.nodes.push_back(std::move(node));
        return okStatus();
    }
    node.mesh = indexMember(json, "mesh");
    if (const int camera = indexMember(json, "camera"); camera >= 0) {
        GLINT_TRY_DO(placeCamera(document, camera, node, scene));
    }
    if (const Json* light = findExtension(json, "KHR_lights_punctual")) {
        GLINT_TRY_DO(placeLight(document, (*light)["light"].get<int>(), node, scene));
    }
    scene.nodes.push_back(std::move(node));
    return okStatus();
}

}  // namespace

Status importNodes(Document& document, Scene& scene) {
    GLINT_TRY(const auto parents, findParents(document));
    GLINT_TRY_DO(checkCycles(document, parents));
    GLINT_TRY_DO(chooseScene(document, scene));
    const Extent extent = extentOf(document, scene.sceneInFile, parents);
    // Nodes are visited depth first, and children in the file's order. The last one on the stack is next.
    struct Pending {
        std::size_t node;
        int parent;  // index into scene.nodes
    };
    std::vector<Pending> pending;
    for (auto root = extent.roots.rbegin(); root != extent.roots.rend(); ++root) {
        pending.push_back({*root, -1});
    }
    while (!pending.empty()) {
        const Pending next = pending.back();
        pending.pop_back();
        const int parent = static_cast<int>(scene.nodes.size());
        GLINT_TRY_DO(appendNode(document, next.node, extent.parts[next.node], next.parent, scene));
        const Json& children = arrayMember(document.json()["nodes"][next.node], "children");
        for (std::size_t i = children.size(); i-- > 0;) {
            const auto child = children[i].get<std::size_t>();
            if (extent.parts[child] != Part::None) {
                pending.push_back({child, parent});
            }
        }
    }
    return okStatus();
}

}  // namespace glint::gltf

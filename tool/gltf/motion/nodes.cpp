// Imports the node hierarchy of one of the file's scenes, and the cameras and lights that it places.
#include "base/text.h"
#include "base/vectors.h"
#include "gltf/motion/transform.h"
#include "gltf/planning_inputs.h"
#include "gltf/steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glint::gltf {

// ---- Cameras and lights where a node places them ----

namespace {

// Warns if a light's value is out of range. Returns the value to use.
double clampLight(Document& document, const std::string& pointer, double value, double low, double high) {
    const double clamped = std::clamp(value, low, high);
    if (clamped != value) {
        document.warn("light-range", pointer, fmt::format("is {}; {} is used", value, clamped),
                      "correct the light's value");
    }
    return clamped;
}

Matrix4 poseOf(Document& document, const std::string& pointer, const Matrix4& world) {
    if (const auto rigid = rigidPart(world)) {
        return *rigid;
    }
    document.warn("pose-degenerate", pointer,
                  "its node's scale leaves no direction; the world's axes are used",
                  "give the node a scale that is not zero");
    Matrix4 pose = identity();
    std::copy(world.begin() + 12, world.begin() + 15, pose.begin() + 12);
    return pose;
}

void readSpot(Document& document, const Json& json, const std::string& pointer, Light& light) {
    constexpr double kRightAngle = std::numbers::pi / 2;
    const Json* spot = find(json, "spot");
    if (spot == nullptr) {
        document.warn("light-range", pointer, "is a spot light without \"spot\"; its angles are the defaults",
                      "give the light its angles");
    }
    const Json empty = Json::object();
    const Json& angles = spot == nullptr ? empty : *spot;
    const double outer =
        clampLight(document, pointer + "/spot/outerConeAngle",
                   memberOr(angles, "outerConeAngle", std::numbers::pi / 4), 0.0, kRightAngle);
    const double given = memberOr(angles, "innerConeAngle", 0.0);
    const double inner = clampLight(document, pointer + "/spot/innerConeAngle", given, 0.0, outer);
    light.outerConeAngle = static_cast<float>(outer);
    light.innerConeAngle = static_cast<float>(inner);
    if (given == outer) {
        document.warn("light-range", pointer + "/spot",
                      "the inner angle is no smaller than the outer one: the cone has a sharp edge",
                      "make innerConeAngle smaller than outerConeAngle");
    }
}

// Returns the range in metres. 0 means unlimited: the file gives none, or none that is above 0.
float readRange(Document& document, const Json& json, const std::string& pointer) {
    const Json* range = find(json, "range");
    const double metres = range == nullptr ? 0.0 : range->get<double>();
    if (range != nullptr && metres <= 0.0) {
        document.warn("light-range", pointer, fmt::format("is {}; the light's range is unlimited", metres),
                      "use more than 0, or leave it out");
    }
    return static_cast<float>(std::max(metres, 0.0));
}

// Values above 1 stay, because a clamped channel would change the hue.
float readChannel(Document& document, const std::string& pointer, double value) {
    if (value > 1.0) {
        document.warn("light-range", pointer, fmt::format("is {}, above 1; it is used as it is", value),
                      "scale the colour down and the intensity up");
        return static_cast<float>(value);
    }
    return static_cast<float>(clampLight(document, pointer, value, 0.0, 1.0));
}

Result<Camera> importCamera(Document& document, int index, const Matrix4& world) {
    const tinygltf::Camera& file = document.model().cameras[static_cast<std::size_t>(index)];
    const std::string pointer = fmt::format("/cameras/{}/{}", index, file.type);
    const auto fail = [&](const char* member, const char* rule, double value) {
        return document.error("camera-range", fmt::format("{}/{}", pointer, member),
                              fmt::format("is {}; it must be {}", value, rule), "correct the camera");
    };
    Camera camera;
    camera.name = file.name;
    camera.source = index;
    camera.world = poseOf(document, fmt::format("/cameras/{}", index), world);
    camera.orthographic = file.type == "orthographic";
    if (camera.orthographic) {
        camera.xmag = std::abs(file.orthographic.xmag);
        camera.ymag = std::abs(file.orthographic.ymag);
        camera.znear = file.orthographic.znear;
        if (camera.xmag == 0.0 || camera.ymag == 0.0) {
            return fail(camera.xmag == 0.0 ? "xmag" : "ymag", "other than 0", 0.0);
        }
        if (file.orthographic.xmag < 0.0 || file.orthographic.ymag < 0.0) {
            document.warn("camera-range", pointer, "has a negative magnification; its size is used");
        }
        if (camera.znear < 0.0) {
            return fail("znear", "0 or more", camera.znear);
        }
    } else {
        camera.yfov = file.perspective.yfov;
        camera.znear = file.perspective.znear;
        if (camera.yfov <= 0.0 || camera.yfov >= std::numbers::pi) {
            return fail("yfov", "between 0 and pi", camera.yfov);
        }
        if (camera.znear <= 0.0) {
            return fail("znear", "above 0", camera.znear);
        }
    }
    const std::optional<double> zfar = farPlane(file);
    camera.zfar = zfar.value_or(0.0);
    if (zfar && camera.zfar <= camera.znear) {
        return fail("zfar", "above znear", camera.zfar);
    }
    return camera;
}

Result<Light> importLight(Document& document, int index, const Matrix4& world) {
    const std::string pointer = fmt::format("/extensions/KHR_lights_punctual/lights/{}", index);
    const Json& json =
        document.json()["extensions"]["KHR_lights_punctual"]["lights"][static_cast<std::size_t>(index)];
    Light light;
    light.source = index;
    light.name = memberOr<std::string>(json, "name", "");
    const std::string& type = json["type"].get_ref<const std::string&>();
    if (type == "spot") {
        light.type = LightType::Spot;
        readSpot(document, json, pointer, light);
    } else if (type == "point") {
        light.type = LightType::Point;
    } else if (type != "directional") {
        return document.error("light-type", pointer + "/type",
                              fmt::format("\"{}\" is no type of light", type),
                              "use directional, point or spot");
    }
    constexpr double kLargest = std::numeric_limits<float>::max();
    light.intensity = static_cast<float>(
        clampLight(document, pointer + "/intensity", memberOr(json, "intensity", 1.0), 0.0, kLargest));
    light.range = readRange(document, json, pointer + "/range");
    if (light.type == LightType::Directional && light.range > 0.0F) {
        document.warn("light-range", pointer + "/range", "a directional light has no range; it is ignored",
                      "leave the range out, or use a point or spot light");
        light.range = 0.0F;
    }
    if (const Json* color = find(json, "color")) {
        for (std::size_t i = 0; i < 3; ++i) {
            light.color[i] =
                readChannel(document, fmt::format("{}/color/{}", pointer, i), (*color)[i].get<double>());
        }
    }
    light.position = {world[12], world[13], world[14]};
    if (light.type != LightType::Point) {
        const auto axis = normalized({-world[8], -world[9], -world[10]});
        if (!axis) {
            document.warn("pose-degenerate", pointer, "its node's scale leaves no direction; -Z is used",
                          "give the node a scale that is not zero");
        }
        light.direction = base::toFloat3(axis.value_or(glm::dvec3{0.0, 0.0, -1.0}));
    }
    return light;
}

// ---- Nodes ----

constexpr const char* kExportNodes = "export the scene again";

std::string pointerOf(std::size_t node) {
    return fmt::format("/nodes/{}", node);
}

// Returns the parent of each node, which is -1 for roots.
Result<std::vector<int>> findParents(const Document& document) {
    const std::vector<tinygltf::Node>& nodes = document.model().nodes;
    std::vector<int> parents(nodes.size(), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (const int child : nodes[i].children) {
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

std::vector<std::size_t> rootsOf(const std::vector<int>& parents) {
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < parents.size(); ++i) {
        if (parents[i] < 0) {
            roots.push_back(i);
        }
    }
    return roots;
}

// Every node has at most one parent, so a node that no root reaches is on a cycle or below one.
Status checkCycles(const Document& document, const std::vector<int>& parents) {
    std::vector<bool> reached(parents.size());
    visitTrees(document, rootsOf(parents), [&](std::size_t node) {
        reached[node] = true;
        return true;
    });
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
    const tinygltf::Model& model = document.model();
    for (const tinygltf::Scene& inFile : model.scenes) {
        scene.scenesInFile.push_back(inFile.name);
    }
    const std::string& wanted = document.options().scene;
    const auto count = static_cast<int>(model.scenes.size());
    if (wanted.empty()) {
        scene.sceneInFile = count > 0 ? std::max(model.defaultScene, 0) : -1;
        if (count > 1 && model.defaultScene < 0) {
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

// Warns of what a scene may not list, and returns the other nodes in the file's order.
std::vector<std::size_t> listedNodes(Document& document, int scene, std::size_t count) {
    std::vector<std::size_t> nodes;
    std::vector<bool> known(count);
    const std::vector<int>& list = document.model().scenes[static_cast<std::size_t>(scene)].nodes;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const auto node = static_cast<std::size_t>(list[i]);
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
    const std::vector<std::size_t> listed =
        scene < 0 ? rootsOf(parents) : listedNodes(document, scene, parents.size());
    visitTrees(document, listed, [&](std::size_t node) {
        return std::exchange(extent.parts[node], Part::Whole) != Part::Whole;
    });
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

Matrix4 readMatrix(Document& document, const std::vector<double>& values, const std::string& pointer) {
    Matrix4 matrix{};
    std::ranges::copy(values, matrix.begin());
    if (!clearProjection(matrix)) {
        document.warn("node-matrix", pointer + "/matrix",
                      "its last row is not 0 0 0 1, which glTF asks for, and is ignored", kExportNodes);
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
    const tinygltf::Node& file = document.model().nodes[index];
    const std::string pointer = pointerOf(index);
    if (!file.matrix.empty()) {
        placed.matrix = readMatrix(document, file.matrix, pointer);
        return *placed.matrix;
    }
    const auto triple = [](const std::vector<double>& values, double fallback) {
        return values.size() == 3 ? std::array{values[0], values[1], values[2]}
                                  : std::array{fallback, fallback, fallback};
    };
    placed.rest = {triple(file.translation, 0.0), readRotation(document, file.rotation, pointer),
                   triple(file.scale, 1.0)};
    return compose(placed.rest);
}

Status appendNode(Document& document, std::size_t index, Part part, int parent, Scene& scene) {
    const tinygltf::Node& file = document.model().nodes[index];
    Node node;
    node.name = file.name;
    node.parent = parent;
    node.source = static_cast<int>(index);
    const Matrix4 above = parent < 0 ? identity() : scene.nodes[static_cast<std::size_t>(parent)].world;
    node.world = multiply(above, readTransform(document, index, node));
    if (!fitsFloat(node.world)) {
        return document.error("node-transform", pointerOf(index), "its transform in the world overflows",
                              "check the scales of the node and its parents");
    }
    if (const Value* const visibility = extensionOf(file.extensions, "KHR_node_visibility")) {
        node.visible = memberOr(*visibility, "visible", true);
    }
    const bool isWhole = part == Part::Whole;
    node.mesh = isWhole ? file.mesh : -1;
    if (isWhole && file.camera >= 0) {
        GLINT_TRY(auto camera, importCamera(document, file.camera, node.world));
        node.camera = static_cast<int>(scene.cameras.size());
        scene.cameras.push_back(std::move(camera));
    }
    if (const Value* const light = extensionOf(file.extensions, "KHR_lights_punctual");
        isWhole && light != nullptr) {
        GLINT_TRY(auto placed, importLight(document, memberOr(*light, "light", -1), node.world));
        node.light = static_cast<int>(scene.lights.size());
        scene.lights.push_back(std::move(placed));
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
    scene.nodes.reserve(static_cast<std::size_t>(
        std::ranges::count_if(extent.parts, [](Part part) { return part != Part::None; })));
    for (auto root = extent.roots.rbegin(); root != extent.roots.rend(); ++root) {
        pending.push_back({*root, -1});
    }
    while (!pending.empty()) {
        const Pending next = pending.back();
        pending.pop_back();
        const int parent = static_cast<int>(scene.nodes.size());
        GLINT_TRY_DO(appendNode(document, next.node, extent.parts[next.node], next.parent, scene));
        const std::vector<int>& children = document.model().nodes[next.node].children;
        for (std::size_t i = children.size(); i-- > 0;) {
            const auto child = static_cast<std::size_t>(children[i]);
            if (extent.parts[child] != Part::None) {
                pending.push_back({child, parent});
            }
        }
    }
    return okStatus();
}

}  // namespace glint::gltf

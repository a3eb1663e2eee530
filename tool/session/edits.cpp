#include "base/lists.h"
#include "base/text.h"
#include "base/vectors.h"
#include "gltf/import.h"
#include "gltf/motion/animatable.h"
#include "gltf/motion/transform.h"
#include "session/append_scene.h"
#include "settings/settings.h"

#include <glint/session/edits.h>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace glint::session {

namespace {

using gltf::AnimationPath;
using gltf::Node;
using gltf::Scene;

template <typename Number>
std::size_t indexOf(Number index) {
    return static_cast<std::size_t>(index);
}

Node& nodeAt(Scene& scene, int node) {
    return scene.nodes[indexOf(node)];
}

void eraseChannels(Scene& scene, const std::function<bool(const gltf::AnimationChannel&)>& isErased) {
    for (gltf::Animation& animation : scene.animations) {
        std::erase_if(animation.channels, isErased);
    }
}

void eraseNodeChannels(Scene& scene, int node, AnimationPath path) {
    eraseChannels(scene, [&](const gltf::AnimationChannel& channel) {
        return channel.target == node && channel.path == path;
    });
}

// Returns for each node whether it is `top` or below it. Parents come before their children.
std::vector<bool> below(const Scene& scene, int top) {
    std::vector<bool> inside(scene.nodes.size(), false);
    inside[indexOf(top)] = true;
    for (std::size_t i = indexOf(top) + 1; i < scene.nodes.size(); ++i) {
        const int parent = scene.nodes[i].parent;
        inside[i] = parent >= 0 && inside[indexOf(parent)];
    }
    return inside;
}

// Nodes and lights may be seen now that could not be before.
void settleVisibility(Scene& scene) {
    for (Node& node : scene.nodes) {
        const bool parentCan = node.parent < 0 || scene.nodes[indexOf(node.parent)].canShow;
        node.canShow = node.canShow || (node.visible && parentCan);
        if (node.light >= 0) {
            gltf::Light& light = scene.lights[indexOf(node.light)];
            light.canShine = light.canShine || (node.canShow && light.intensity > 0.0F);
        }
    }
}

// --- Errors ---

Diagnostic unknown(const Edit& edit, const char* member, const std::string& what, const std::string& text,
                   std::vector<std::string> names) {
    std::erase_if(names, [](const std::string& name) { return name.empty(); });
    return makeError("edit-unknown", edit.place + "/" + member,
                     fmt::format("there is no {} \"{}\"{}", what, text, base::suggestion(text, names)),
                     "use a name, or a number of the file as a text");
}

Diagnostic impossible(const Edit& edit, const std::string& member, const std::string& message,
                      const std::string& hint) {
    return makeError("edit-value", edit.place + member, message, hint);
}

Result<int> nodeOf(const Edit& edit, const char* member, const std::string& text, const Scene& scene) {
    if (const std::optional<int> found = findNode(scene, text)) {
        return *found;
    }
    return unknown(edit, member, "node", text, base::mapped<std::string>(scene.nodes, &Node::name));
}

Result<int> materialOf(const Edit& edit, const Scene& scene) {
    std::vector<std::string> names = base::mapped<std::string>(scene.materials, &materials::Material::name);
    const auto found = std::ranges::find(names, edit.material);
    if (found != names.end()) {
        return static_cast<int>(found - names.begin());
    }
    std::int64_t number = 0;
    if (compiler::parseWhole(edit.material, 0, static_cast<std::int64_t>(names.size()) - 1, number)) {
        return static_cast<int>(number);
    }
    return unknown(edit, "material", "material", edit.material, std::move(names));
}

// --- Transforms ---

bool givesTransform(const Edit& edit) {
    return !edit.translation.empty() || !edit.rotation.empty() || !edit.scale.empty() || !edit.matrix.empty();
}

// Returns the parts of a matrix, or nothing if it has a shear.
std::optional<gltf::Transform> partsOf(const gltf::Matrix4& matrix) {
    glm::dmat3 linear(base::toMatrix(matrix));
    gltf::Transform parts;
    std::copy_n(matrix.begin() + 12, 3, parts.translation.begin());
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        double length = glm::length(linear[axis]);
        if (!(length > 0.0)) {
            return std::nullopt;
        }
        length = axis == 0 && glm::determinant(linear) < 0.0 ? -length : length;
        parts.scale[indexOf(axis)] = length;
        linear[axis] /= length;
    }
    const glm::dquat turn = glm::quat_cast(linear);
    parts.rotation = {turn.x, turn.y, turn.z, turn.w};
    const gltf::Matrix4 again = gltf::compose(parts);
    for (std::size_t i = 0; i < 12; ++i) {
        // Files have single precision.
        if (!(std::abs(again[i] - matrix[i]) <= 1e-5 * std::abs(parts.scale[i / 4]))) {
            return std::nullopt;
        }
    }
    return parts;
}

Status setTransform(const Edit& edit, Scene& scene, int index) {
    Node& node = nodeAt(scene, index);
    if (!edit.matrix.empty()) {
        std::copy_n(edit.matrix.begin(), 16, node.matrix.emplace().begin());
        eraseChannels(scene, [&](const gltf::AnimationChannel& channel) {
            return channel.target == index && gltf::drivesTransform(channel.path);
        });
        return okStatus();
    }
    if (node.matrix && givesTransform(edit)) {
        const std::optional<gltf::Transform> parts = partsOf(*node.matrix);
        if (!parts) {
            return impossible(edit, "", "the matrix of the node is no product of the three", "give a matrix");
        }
        node.rest = *parts;
        node.matrix.reset();
    }
    if (!edit.translation.empty()) {
        std::copy_n(edit.translation.begin(), 3, node.rest.translation.begin());
        eraseNodeChannels(scene, index, AnimationPath::Translation);
    }
    if (!edit.rotation.empty()) {
        const glm::dquat turn = glm::normalize(
            glm::dquat(edit.rotation[3], edit.rotation[0], edit.rotation[1], edit.rotation[2]));
        node.rest.rotation = {turn.x, turn.y, turn.z, turn.w};
        eraseNodeChannels(scene, index, AnimationPath::Rotation);
    }
    if (!edit.scale.empty()) {
        std::copy_n(edit.scale.begin(), 3, node.rest.scale.begin());
        eraseNodeChannels(scene, index, AnimationPath::Scale);
    }
    return okStatus();
}

// --- Nodes ---

// Whether the things that belong to a node are copied with it, or go with it.
enum class Copying : std::uint8_t { Copies, Moves };

int copyLight(Scene& scene, int light) {
    const auto index = static_cast<int>(scene.lights.size());
    scene.lights.push_back(gltf::Light(scene.lights[indexOf(light)]));
    if (!scene.restLights.empty()) {
        scene.restLights.push_back(gltf::Light(scene.restLights[indexOf(light)]));
    }
    return index;
}

// Copies a node and all below it to the end of the list, below `parent`. Channels of animations, and skins
// with joints among these nodes, get copies, too, or are given over. Returns the new number of each node, or
// -1.
std::vector<int> copyNodes(Scene& scene, int top, int parent, Copying copying) {
    const std::vector<bool> inside = below(scene, top);
    std::vector<int> numbers(scene.nodes.size(), -1);
    std::map<int, int> lights;
    int number = nextNumber(scene);
    for (std::size_t i = 0; i < inside.size(); ++i) {
        if (!inside[i]) {
            continue;
        }
        numbers[i] = static_cast<int>(scene.nodes.size());
        Node node = scene.nodes[i];
        node.parent = static_cast<int>(i) == top ? parent : numbers[indexOf(node.parent)];
        if (copying == Copying::Copies) {
            node.source = node.source < 0 ? -1 : number++;
            node.camera = -1;
            if (node.light >= 0) {
                const int copy = copyLight(scene, node.light);
                lights[node.light] = copy;
                node.light = copy;
            }
        }
        scene.nodes.push_back(std::move(node));
    }
    const auto isInside = [&](int joint) { return inside[indexOf(joint)]; };
    std::map<int, int> skins;
    const std::size_t skinCount = scene.skins.size();
    for (std::size_t i = 0; i < skinCount; ++i) {
        if (std::ranges::none_of(scene.skins[i].joints, isInside)) {
            continue;
        }
        gltf::Skin skin = scene.skins[i];
        for (int& joint : skin.joints) {
            joint = isInside(joint) ? numbers[indexOf(joint)] : joint;
        }
        if (copying == Copying::Moves) {
            scene.skins[i] = std::move(skin);
        } else {
            skins[static_cast<int>(i)] = static_cast<int>(scene.skins.size());
            scene.skins.push_back(std::move(skin));
        }
    }
    for (std::size_t i = inside.size(); i < scene.nodes.size(); ++i) {
        const auto found = skins.find(scene.nodes[i].skin);
        scene.nodes[i].skin = found == skins.end() ? scene.nodes[i].skin : found->second;
    }
    for (gltf::Animation& animation : scene.animations) {
        const std::size_t count = animation.channels.size();
        for (std::size_t i = 0; i < count; ++i) {
            gltf::AnimationChannel channel = animation.channels[i];
            const bool ofNode = gltf::drivesNode(channel.path) && isInside(channel.target);
            const auto light =
                channel.path == AnimationPath::Light ? lights.find(channel.target) : lights.end();
            if (!ofNode && light == lights.end()) {
                continue;
            }
            channel.target = ofNode ? numbers[indexOf(channel.target)] : light->second;
            if (copying == Copying::Moves) {
                animation.channels[i] = channel;
            } else {
                animation.channels.push_back(channel);
            }
        }
    }
    return numbers;
}

// Leaves an empty node, whose transform goes on to move the joints that follow it.
void leave(Node& node) {
    node.mesh = node.light = node.camera = node.source = -1;
    node.name.clear();
    node.visible = node.canShow = node.shown = false;
    node.restWeights.clear();
}

void removeNodes(Scene& scene, int top) {
    const std::vector<bool> inside = below(scene, top);
    for (std::size_t i = 0; i < inside.size(); ++i) {
        if (inside[i]) {
            if (const int light = scene.nodes[i].light; light >= 0) {
                scene.lights[indexOf(light)].shown = false;
                if (!scene.restLights.empty()) {
                    scene.restLights[indexOf(light)].shown = false;
                }
            }
            leave(scene.nodes[i]);
        }
    }
    eraseChannels(scene, [&](const gltf::AnimationChannel& channel) {
        return gltf::drivesNode(channel.path) && !gltf::drivesTransform(channel.path) &&
               inside[indexOf(channel.target)];
    });
}

// Returns the node, which has another number if its parent comes after it.
int putBelow(Scene& scene, int node, int parent) {
    if (parent < node) {
        nodeAt(scene, node).parent = parent;
        return node;
    }
    const std::vector<int> numbers = copyNodes(scene, node, parent, Copying::Moves);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (numbers[i] >= 0) {
            leave(scene.nodes[i]);
        }
    }
    return numbers[indexOf(node)];
}

// --- Materials ---

int addCopy(Scene& scene, gltf::Mesh mesh, int of) {
    const gltf::Mesh& original = scene.meshes[indexOf(of)];
    mesh.copyOf = original.copyOf < 0 ? of : original.copyOf;
    const auto same = std::ranges::find_if(scene.meshes, [&](const gltf::Mesh& known) {
        return known.copyOf == mesh.copyOf &&
               std::ranges::equal(
                   known.primitives, mesh.primitives, [](const gltf::Primitive& a, const gltf::Primitive& b) {
                       return a.material == b.material && a.variantMaterials == b.variantMaterials;
                   });
    });
    const auto index = static_cast<int>(same - scene.meshes.begin());
    if (same == scene.meshes.end()) {
        scene.meshes.push_back(std::move(mesh));
    }
    return index;
}

Result<int> setMaterial(const Edit& edit, Scene& scene, int index) {
    GLINT_TRY(const int material, materialOf(edit, scene));
    Node& node = nodeAt(scene, index);
    if (node.mesh < 0) {
        return impossible(edit, "/node", "the node has no mesh", "name a node with a mesh");
    }
    gltf::Mesh mesh = scene.meshes[indexOf(node.mesh)];
    if (edit.primitive && *edit.primitive >= mesh.primitives.size()) {
        return impossible(edit, "/primitive",
                          fmt::format("the mesh has {} primitives", mesh.primitives.size()), "count from 0");
    }
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        if (edit.primitive.value_or(i) == i) {
            mesh.primitives[i].material = material;
            mesh.primitives[i].variantMaterials.clear();
        }
    }
    node.mesh = addCopy(scene, std::move(mesh), node.mesh);
    return index;
}

Status setVariant(const Edit& edit, Scene& scene) {
    const auto found = std::ranges::find(scene.variants, edit.variant);
    if (!edit.variant.empty() && found == scene.variants.end()) {
        return makeError("variant-unknown", edit.place + "/variant",
                         fmt::format("there is no variant \"{}\"{}", edit.variant,
                                     base::suggestion(edit.variant, scene.variants)),
                         scene.variants.empty() ? "leave the edit out" : "use another name");
    }
    for (gltf::Mesh& mesh : scene.meshes) {
        for (gltf::Primitive& primitive : mesh.primitives) {
            if (!primitive.variantMaterials.empty()) {
                primitive.material =
                    edit.variant.empty()
                        ? primitive.variantMaterials.back()
                        : primitive.variantMaterials[indexOf(found - scene.variants.begin())];
            }
        }
    }
    scene.variant = edit.variant;
    return okStatus();
}

Result<int> setLight(const Edit& edit, Scene& scene, int index) {
    const Node& node = nodeAt(scene, index);
    if (node.light < 0) {
        return impossible(edit, "/node", "the node has no light", "name a node with a light");
    }
    const auto set = [&](gltf::Light& light) {
        for (std::size_t i = 0; i < edit.color.size(); ++i) {
            light.color[i] = static_cast<float>(edit.color[i]);
        }
        light.intensity = edit.intensity ? static_cast<float>(*edit.intensity) : light.intensity;
    };
    set(scene.lights[indexOf(node.light)]);
    if (!scene.restLights.empty()) {
        set(scene.restLights[indexOf(node.light)]);
    }
    const std::optional<int> color = gltf::findLightProperty("color");
    const std::optional<int> intensity = gltf::findLightProperty("intensity");
    eraseChannels(scene, [&](const gltf::AnimationChannel& channel) {
        return channel.path == AnimationPath::Light && channel.target == node.light &&
               ((!edit.color.empty() && channel.property == color) ||
                (edit.intensity && channel.property == intensity));
    });
    return index;
}

Result<int> addFile(const Edit& edit, const SceneFiles& files, int parent, Scene& scene) {
    const auto found = files.find(edit.file);
    if (found == files.end()) {
        return makeError("edit-unknown", edit.place + "/file", "the file was not read", "name another file");
    }
    const auto index = static_cast<int>(scene.nodes.size());
    Node holder;
    holder.name = edit.name.empty() ? std::filesystem::path(edit.file).stem().string() : edit.name;
    holder.parent = parent;
    holder.source = nextNumber(scene);
    holder.canShow = false;
    scene.nodes.push_back(std::move(holder));
    GLINT_TRY_DO(setTransform(edit, scene, index));
    appendScene(*found->second, index, scene);
    return index;
}

Result<int> duplicate(const Edit& edit, Scene& scene, int node, int parent) {
    if (below(scene, node)[indexOf(std::max(parent, 0))] && parent >= 0) {
        return impossible(edit, "/parent", "the parent is the node itself or below it",
                          "name another parent");
    }
    const std::vector<int> numbers = copyNodes(scene, node, parent, Copying::Copies);
    const int copy = numbers[indexOf(node)];
    nodeAt(scene, copy).name = edit.name.empty() ? nodeAt(scene, node).name + " copy" : edit.name;
    if (Status set = setTransform(edit, scene, copy); !set) {
        removeNodes(scene, copy);
        return set.error();
    }
    return copy;
}

}  // namespace

Status readFiles(std::span<const Edit> edits, gltf::ImportOptions options, SceneFiles& files) {
    options.trustTextures = false;
    options.scene.clear();
    options.variant.clear();
    for (const Edit& edit : edits) {
        if (edit.kind == EditKind::Add && !files.contains(edit.file)) {
            GLINT_TRY(auto read, gltf::importScene(edit.file, options));
            files.emplace(edit.file, std::make_shared<const gltf::Scene>(std::move(read)));
        }
    }
    return okStatus();
}

std::optional<int> findNode(const gltf::Scene& scene, const std::string& text) {
    const auto found = std::ranges::find_if(
        scene.nodes, [&](const Node& node) { return !text.empty() && node.name == text; });
    if (found != scene.nodes.end()) {
        return static_cast<int>(found - scene.nodes.begin());
    }
    std::int64_t number = 0;
    if (!compiler::parseWhole(text, 0, std::numeric_limits<int>::max(), number)) {
        return std::nullopt;
    }
    const auto numbered = std::ranges::find(scene.nodes, static_cast<int>(number), &Node::source);
    return numbered == scene.nodes.end() ? std::nullopt
                                         : std::optional(static_cast<int>(numbered - scene.nodes.begin()));
}

std::string nodeLabel(const gltf::Scene& scene, int node) {
    const Node& one = scene.nodes[indexOf(node)];
    return findNode(scene, one.name) == node ? one.name : std::to_string(one.source);
}

bool isPresent(const gltf::Node& node) {
    return node.source >= 0;
}

Result<int> applyEdit(const Edit& edit, const SceneFiles& files, gltf::Scene& scene) {
    int node = -1;
    if (edit.kind != EditKind::Variant && edit.kind != EditKind::Add) {
        GLINT_TRY(node, nodeOf(edit, "node", edit.node, scene));
    }
    int parent = edit.kind == EditKind::Duplicate ? nodeAt(scene, node).parent : -1;
    if (!edit.parent.empty()) {
        GLINT_TRY(parent, nodeOf(edit, "parent", edit.parent, scene));
    }
    switch (edit.kind) {
        case EditKind::Hide:
        case EditKind::Show:
            nodeAt(scene, node).visible = edit.kind == EditKind::Show;
            eraseNodeChannels(scene, node, AnimationPath::Visible);
            break;
        case EditKind::Move:
            GLINT_TRY_DO(setTransform(edit, scene, node));
            break;
        case EditKind::Delete:
            removeNodes(scene, node);
            break;
        case EditKind::Duplicate: {
            GLINT_TRY(node, duplicate(edit, scene, node, parent));
            break;
        }
        case EditKind::Parent:
            if (parent >= 0 && below(scene, node)[indexOf(parent)]) {
                return impossible(edit, "/parent", "the parent is the node itself or below it",
                                  "name another parent");
            }
            node = putBelow(scene, node, parent);
            break;
        case EditKind::Material: {
            GLINT_TRY(node, setMaterial(edit, scene, node));
            break;
        }
        case EditKind::Light: {
            GLINT_TRY(node, setLight(edit, scene, node));
            break;
        }
        case EditKind::Variant:
            GLINT_TRY_DO(setVariant(edit, scene));
            break;
        case EditKind::Add: {
            GLINT_TRY(node, addFile(edit, files, parent, scene));
            break;
        }
    }
    settleVisibility(scene);
    return node;
}

std::optional<gltf::Transform> localTransform(const gltf::Node& node) {
    return node.matrix ? partsOf(*node.matrix) : std::optional(node.rest);
}

bool needShaders(std::span<const Edit> edits) {
    return std::ranges::any_of(edits, [](const Edit& edit) {
        return edit.kind == EditKind::Show || edit.kind == EditKind::Material ||
               edit.kind == EditKind::Light || edit.kind == EditKind::Variant || edit.kind == EditKind::Add;
    });
}

bool needsShaders(const Edit& edit, const gltf::Scene& scene) {
    const std::optional<int> node = findNode(scene, edit.node);
    if (node && edit.kind == EditKind::Light) {
        const int light = scene.nodes[indexOf(*node)].light;
        return light >= 0 && !scene.lights[indexOf(light)].canShine;
    }
    if (!node || edit.kind != EditKind::Show) {
        return needShaders(std::span(&edit, 1));
    }
    const std::vector<bool> inside = below(scene, *node);
    bool allCanShow = true;
    for (std::size_t i = 0; i < inside.size(); ++i) {
        allCanShow = allCanShow && (!inside[i] || !isPresent(scene.nodes[i]) || scene.nodes[i].canShow);
    }
    return !allCanShow;
}

Result<gltf::Scene> plannedScene(const gltf::Scene& scene, std::span<const Edit> edits,
                                 const SceneFiles& files) {
    Scene planned = scene;
    for (const Edit& edit : edits) {
        // A variant changes meshes in their place; their present materials are needed, too.
        const std::size_t count = edit.kind == EditKind::Variant ? planned.meshes.size() : 0;
        for (std::size_t i = 0; i < count; ++i) {
            const auto maps = [](const gltf::Primitive& one) { return !one.variantMaterials.empty(); };
            if (std::ranges::any_of(planned.meshes[i].primitives, maps)) {
                gltf::Mesh copy = planned.meshes[i];
                for (gltf::Primitive& primitive : copy.primitives) {
                    primitive.variantMaterials.clear();
                }
                addCopy(planned, std::move(copy), static_cast<int>(i));
            }
        }
        GLINT_TRY([[maybe_unused]] const int node, applyEdit(edit, files, planned));
    }
    return planned;
}

}  // namespace glint::session

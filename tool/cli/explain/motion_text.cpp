#include "cli/explain/motion_text.h"

#include "cli/table.h"
#include "scene/deformed.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <vector>

namespace glint {

namespace {

constexpr std::string_view nameOf(AnimationPath path) {
    switch (path) {
        case AnimationPath::Translation:
            return "translation";
        case AnimationPath::Rotation:
            return "rotation";
        case AnimationPath::Scale:
            return "scale";
        case AnimationPath::Visible:
            return "visible";
        case AnimationPath::Material:
            return "material";
        case AnimationPath::Light:
            return "light";
        case AnimationPath::Camera:
            return "camera";
        case AnimationPath::Weights:
        case AnimationPath::Weight:
            break;
    }
    return "weights";
}

// Returns whether a channel of that path drives a node.
bool drivesNode(AnimationPath path) {
    return path != AnimationPath::Material && path != AnimationPath::Light && path != AnimationPath::Camera;
}

constexpr AnimationPath kPaths[] = {
    AnimationPath::Translation, AnimationPath::Rotation, AnimationPath::Scale, AnimationPath::Weights,
    AnimationPath::Visible,     AnimationPath::Material, AnimationPath::Light, AnimationPath::Camera};

// Counts channels by the property that they move. A channel of one weight counts with those of all weights.
std::map<AnimationPath, std::size_t> channelsOf(const Animation& animation) {
    std::map<AnimationPath, std::size_t> counts;
    for (const AnimationChannel& channel : animation.channels) {
        ++counts[channel.path == AnimationPath::Weight ? AnimationPath::Weights : channel.path];
    }
    return counts;
}

std::size_t nodesOf(const Animation& animation) {
    std::set<int> nodes;
    for (const AnimationChannel& channel : animation.channels) {
        if (drivesNode(channel.path)) {
            nodes.insert(channel.target);
        }
    }
    return nodes.size();
}

// A mesh, and a node that draws it.
struct Deformed {
    const Node* node = nullptr;
    std::size_t joints = 0;      // joints of its skin; 0 if it follows none
    std::size_t influences = 0;  // the most joints that a vertex follows
    std::size_t targets = 0;
    std::size_t vertices = 0;
};

std::vector<Deformed> deformedOf(const Scene& scene) {
    std::vector<Deformed> all;
    for (const Node& node : scene.nodes) {
        if (!isDeformed(scene, node)) {
            continue;
        }
        Deformed deformed{&node};
        for (const Primitive& primitive : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
            deformed.vertices += primitive.positions.size();
            deformed.targets = std::max(deformed.targets, primitive.targets.size());
            deformed.influences = std::max(deformed.influences, primitive.influences.count);
        }
        if (node.skin >= 0 && deformed.influences > 0) {
            deformed.joints = scene.skins[static_cast<std::size_t>(node.skin)].joints.size();
        } else {
            deformed.influences = 0;
        }
        all.push_back(deformed);
    }
    return all;
}

std::string meshName(const Scene& scene, int mesh) {
    const std::string& name = scene.meshes[static_cast<std::size_t>(mesh)].name;
    return name.empty() ? fmt::format("mesh {}", mesh) : name;
}

}  // namespace

Json motionToJson(const Scene& scene) {
    Json animations = Json::array();
    for (std::size_t i = 0; i < scene.animations.size(); ++i) {
        const Animation& animation = scene.animations[i];
        Json channels = Json::object();
        for (const AnimationPath path : kPaths) {
            channels[std::string(nameOf(path))] = 0;
        }
        for (const auto& [path, count] : channelsOf(animation)) {
            channels[std::string(nameOf(path))] = count;
        }
        animations.push_back({{"index", i},
                              {"name", animation.name},
                              {"duration", animation.duration},
                              {"nodes", nodesOf(animation)},
                              {"channels", channels}});
    }
    Json meshes = Json::array();
    for (const Deformed& deformed : deformedOf(scene)) {
        meshes.push_back({{"node", deformed.node->source},
                          {"mesh", deformed.node->mesh},
                          {"name", scene.meshes[static_cast<std::size_t>(deformed.node->mesh)].name},
                          {"vertices", deformed.vertices},
                          {"joints", deformed.joints},
                          {"influences", deformed.influences},
                          {"morphTargets", deformed.targets}});
    }
    return {{"animations", animations}, {"deformedMeshes", meshes}};
}

std::string motionText(const Scene& scene) {
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < scene.animations.size(); ++i) {
        const Animation& animation = scene.animations[i];
        std::string channels;
        for (const auto& [path, count] : channelsOf(animation)) {
            channels += fmt::format("{}{} of {}", channels.empty() ? "" : ", ", count, nameOf(path));
        }
        rows.push_back({fmt::format("animation {}", i),
                        fmt::format("{}{:.3f} s, {} nodes, channels: {}",
                                    animation.name.empty() ? "" : animation.name + ", ", animation.duration,
                                    nodesOf(animation), channels.empty() ? "none" : channels)});
    }
    for (const Deformed& deformed : deformedOf(scene)) {
        std::string follows;
        if (deformed.joints > 0) {
            follows = fmt::format("{} joints, up to {} a vertex", deformed.joints, deformed.influences);
        }
        if (deformed.targets > 0) {
            follows += fmt::format("{}{} morph targets", follows.empty() ? "" : "; ", deformed.targets);
        }
        rows.push_back(
            {"deformed", fmt::format("{} (/nodes/{}), {} vertices: {}", meshName(scene, deformed.node->mesh),
                                     deformed.node->source, deformed.vertices, follows)});
    }
    return rows.empty() ? "" : formatFields(rows);
}

}  // namespace glint

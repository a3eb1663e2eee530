#include "cli/explain/motion_text.h"

#include "cli/table.h"
#include "scene/deformed.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <vector>

namespace glint::cli {

namespace {

constexpr std::string_view nameOf(gltf::AnimationPath path) {
    switch (path) {
        case gltf::AnimationPath::Translation:
            return "translation";
        case gltf::AnimationPath::Rotation:
            return "rotation";
        case gltf::AnimationPath::Scale:
            return "scale";
        case gltf::AnimationPath::Visible:
            return "visible";
        case gltf::AnimationPath::Material:
            return "material";
        case gltf::AnimationPath::Light:
            return "light";
        case gltf::AnimationPath::Camera:
            return "camera";
        case gltf::AnimationPath::Weights:
        case gltf::AnimationPath::Weight:
            break;
    }
    return "weights";
}

// Returns whether a channel of that path drives a node.
bool drivesNode(gltf::AnimationPath path) {
    return path != gltf::AnimationPath::Material && path != gltf::AnimationPath::Light &&
           path != gltf::AnimationPath::Camera;
}

constexpr gltf::AnimationPath kPaths[] = {gltf::AnimationPath::Translation, gltf::AnimationPath::Rotation,
                                          gltf::AnimationPath::Scale,       gltf::AnimationPath::Weights,
                                          gltf::AnimationPath::Visible,     gltf::AnimationPath::Material,
                                          gltf::AnimationPath::Light,       gltf::AnimationPath::Camera};

// Counts channels by the property that they move. A channel of one weight counts with those of all weights.
std::map<gltf::AnimationPath, std::size_t> channelsOf(const gltf::Animation& animation) {
    std::map<gltf::AnimationPath, std::size_t> counts;
    for (const gltf::AnimationChannel& channel : animation.channels) {
        ++counts[channel.path == gltf::AnimationPath::Weight ? gltf::AnimationPath::Weights : channel.path];
    }
    return counts;
}

std::size_t nodesOf(const gltf::Animation& animation) {
    std::set<int> nodes;
    for (const gltf::AnimationChannel& channel : animation.channels) {
        if (drivesNode(channel.path)) {
            nodes.insert(channel.target);
        }
    }
    return nodes.size();
}

// A mesh, and a node that draws it.
struct Deformed {
    const gltf::Node* node = nullptr;
    std::size_t joints = 0;      // joints of its skin; 0 if it follows none
    std::size_t influences = 0;  // the most joints that a vertex follows
    std::size_t targets = 0;
    std::size_t vertices = 0;
};

std::vector<Deformed> deformedOf(const gltf::Scene& scene) {
    std::vector<Deformed> all;
    for (const gltf::Node& node : scene.nodes) {
        if (!compiler::isDeformed(scene, node)) {
            continue;
        }
        Deformed deformed{&node};
        for (const gltf::Primitive& primitive :
             scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
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

std::string meshName(const gltf::Scene& scene, int mesh) {
    const std::string& name = scene.meshes[static_cast<std::size_t>(mesh)].name;
    return name.empty() ? fmt::format("mesh {}", mesh) : name;
}

}  // namespace

base::Json motionToJson(const gltf::Scene& scene) {
    base::Json animations = base::Json::array();
    for (std::size_t i = 0; i < scene.animations.size(); ++i) {
        const gltf::Animation& animation = scene.animations[i];
        base::Json channels = base::Json::object();
        for (const gltf::AnimationPath path : kPaths) {
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
    base::Json meshes = base::Json::array();
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

std::string motionText(const gltf::Scene& scene) {
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < scene.animations.size(); ++i) {
        const gltf::Animation& animation = scene.animations[i];
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

}  // namespace glint::cli

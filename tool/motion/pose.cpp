#include "motion/pose.h"

#include "gltf/transform.h"
#include "motion/interpolate.h"

#include <algorithm>

namespace glint {

namespace {

using gltf::Double3;

// What animations set: transforms and weights of all nodes.
struct Locals {
    std::vector<Transform> transforms;
    std::vector<std::vector<double>> weights;
};

Locals restOf(const Scene& scene) {
    Locals locals;
    for (const Node& node : scene.nodes) {
        locals.transforms.push_back(node.rest);
        const bool drawn = node.mesh >= 0;
        locals.weights.push_back(drawn ? node.restWeights : std::vector<double>());
    }
    return locals;
}

void applyChannel(const Animation& animation, const AnimationChannel& channel, double time, Locals& locals) {
    const AnimationSampler& sampler = animation.samplers[static_cast<std::size_t>(channel.sampler)];
    const auto node = static_cast<std::size_t>(channel.node);
    if (channel.path == AnimationPath::Rotation) {
        locals.transforms[node].rotation = sampleRotation(sampler, time);
        return;
    }
    const std::vector<double> numbers = sampleNumbers(sampler, time);
    if (channel.path == AnimationPath::Weights) {
        locals.weights[node] = numbers;
    } else {
        Double3& target = channel.path == AnimationPath::Translation ? locals.transforms[node].translation
                                                                     : locals.transforms[node].scale;
        std::copy_n(numbers.begin(), 3, target.begin());
    }
}

Pose poseOf(const Scene& scene, Locals locals) {
    Pose pose;
    pose.worlds.reserve(scene.nodes.size());
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        const Transform& local = locals.transforms[i];
        const Matrix4 matrix =
            node.matrix ? *node.matrix : gltf::compose(local.translation, local.rotation, local.scale);
        pose.worlds.push_back(
            node.parent < 0 ? matrix
                            : gltf::multiply(pose.worlds[static_cast<std::size_t>(node.parent)], matrix));
    }
    pose.weights = std::move(locals.weights);
    return pose;
}

Float3 toFloats(const Double3& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

void placeCamera(const Matrix4& world, Camera& camera) {
    if (const std::optional<Matrix4> rigid = gltf::rigidPart(world)) {
        camera.world = *rigid;
    } else {
        std::copy(world.begin() + 12, world.begin() + 15, camera.world.begin() + 12);
    }
}

void placeLight(const Matrix4& world, Light& light) {
    light.position = toFloats({world[12], world[13], world[14]});
    if (light.type == LightType::Point) {
        return;
    }
    if (const std::optional<Double3> axis = gltf::normalized({-world[8], -world[9], -world[10]})) {
        light.direction = toFloats(*axis);
    }
}

}  // namespace

Pose restPose(const Scene& scene) {
    return poseOf(scene, restOf(scene));
}

Pose poseAt(const Scene& scene, std::span<const std::size_t> animations, double time) {
    Locals locals = restOf(scene);
    for (const std::size_t index : animations) {
        const Animation& animation = scene.animations[index];
        for (const AnimationChannel& channel : animation.channels) {
            applyChannel(animation, channel, time, locals);
        }
    }
    return poseOf(scene, std::move(locals));
}

void applyPose(const Pose& pose, Scene& scene) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        Node& node = scene.nodes[i];
        node.world = pose.worlds[i];
        node.weights = pose.weights[i];
        if (node.camera >= 0) {
            placeCamera(node.world, scene.cameras[static_cast<std::size_t>(node.camera)]);
        }
        if (node.light >= 0) {
            placeLight(node.world, scene.lights[static_cast<std::size_t>(node.light)]);
        }
    }
}

std::vector<Matrix4> jointMatrices(const Scene& scene, const Skin& skin) {
    std::vector<Matrix4> matrices;
    matrices.reserve(skin.joints.size());
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        const Node& joint = scene.nodes[static_cast<std::size_t>(skin.joints[i])];
        matrices.push_back(gltf::multiply(joint.world, skin.inverseBinds[i]));
    }
    return matrices;
}

}  // namespace glint

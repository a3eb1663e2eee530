#include "base/vectors.h"
#include "gltf/motion/animatable.h"
#include "gltf/motion/transform.h"
#include "scene_view/interpolate.h"

#include <glint/scene_view/pose.h>

#include <algorithm>

namespace glint::scene_view {

namespace {

// Values that animations set, with local transforms in place of the pose's world matrices.
struct Locals {
    std::vector<Transform> transforms;
    Pose pose;
};

Locals restOf(const Scene& scene) {
    Locals locals;
    for (const Node& node : scene.nodes) {
        locals.transforms.push_back(node.rest);
        const bool drawn = node.mesh >= 0;
        locals.pose.weights.push_back(drawn ? node.restWeights : std::vector<double>());
        locals.pose.visible.push_back(node.visible);
    }
    for (const AnimatedMaterial& animated : scene.animatedMaterials) {
        locals.pose.materials.push_back(animated.rest);
    }
    locals.pose.lights = scene.restLights;
    locals.pose.cameras = scene.restCameras;
    return locals;
}

void applyChannel(const Animation& animation, const AnimationChannel& channel, double time, Locals& locals) {
    const AnimationSampler& sampler = animation.samplers[static_cast<std::size_t>(channel.sampler)];
    const auto target = static_cast<std::size_t>(channel.target);
    if (channel.path == AnimationPath::Rotation) {
        locals.transforms[target].rotation = sampleRotation(sampler, time);
        return;
    }
    const std::vector<double> numbers = sampleNumbers(sampler, time);
    switch (channel.path) {
        case AnimationPath::Translation:
            std::copy_n(numbers.begin(), 3, locals.transforms[target].translation.begin());
            break;
        case AnimationPath::Scale:
            std::copy_n(numbers.begin(), 3, locals.transforms[target].scale.begin());
            break;
        case AnimationPath::Rotation:
            break;
        case AnimationPath::Weights:
            locals.pose.weights[target] = numbers;
            break;
        case AnimationPath::Weight:
            locals.pose.weights[target][static_cast<std::size_t>(channel.property)] = numbers[0];
            break;
        case AnimationPath::Visible:
            locals.pose.visible[target] = numbers[0] != 0.0;
            break;
        case AnimationPath::Material:
            setMaterialProperty(locals.pose.materials[target], channel.property, numbers);
            break;
        case AnimationPath::Light:
            setLightProperty(locals.pose.lights[target], channel.property, numbers);
            break;
        case AnimationPath::Camera:
            setCameraProperty(locals.pose.cameras[target], channel.property, numbers[0]);
            break;
    }
}

Pose poseOf(const Scene& scene, Locals locals) {
    Pose pose = std::move(locals.pose);
    std::ranges::for_each(pose.lights, settleLight);
    std::ranges::for_each(pose.cameras, settleCamera);
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
    return pose;
}

void placeCamera(const Matrix4& world, Camera& camera) {
    if (const std::optional<Matrix4> rigid = gltf::rigidPart(world)) {
        camera.world = *rigid;
    } else {
        std::copy(world.begin() + 12, world.begin() + 15, camera.world.begin() + 12);
    }
}

void placeLight(const Matrix4& world, Light& light) {
    light.position = toFloat3({world[12], world[13], world[14]});
    if (light.type == LightType::Point) {
        return;
    }
    if (const std::optional<Double3> axis = gltf::normalized({-world[8], -world[9], -world[10]})) {
        light.direction = toFloat3(*axis);
    }
}

Double3 skinned(const SkinInfluences& influences, std::size_t vertex, const Double3& point,
                std::span<const Matrix4> joints) {
    Double3 sum{};
    for (std::size_t i = vertex * influences.count; i < (vertex + 1) * influences.count; ++i) {
        if (influences.weights[i] == 0.0F) {
            continue;
        }
        const Double3 moved = transformed(joints[influences.joints[i]], point);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            sum[axis] += influences.weights[i] * moved[axis];
        }
    }
    return sum;
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
    for (std::size_t i = 0; i < pose.materials.size(); ++i) {
        scene.materials[static_cast<std::size_t>(scene.animatedMaterials[i].material)] = pose.materials[i];
    }
    std::ranges::copy(pose.lights, scene.lights.begin());
    std::ranges::copy(pose.cameras, scene.cameras.begin());
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        Node& node = scene.nodes[i];
        node.world = pose.worlds[i];
        node.weights = pose.weights[i];
        node.shown =
            pose.visible[i] && (node.parent < 0 || scene.nodes[static_cast<std::size_t>(node.parent)].shown);
        if (node.camera >= 0) {
            placeCamera(node.world, scene.cameras[static_cast<std::size_t>(node.camera)]);
        }
        if (node.light >= 0) {
            Light& light = scene.lights[static_cast<std::size_t>(node.light)];
            placeLight(node.world, light);
            light.shown = node.shown;
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

std::vector<Double3> deformedPositions(const Primitive& primitive, std::span<const double> weights,
                                       std::span<const Matrix4> joints) {
    std::vector<Double3> positions;
    positions.reserve(primitive.positions.size());
    const std::size_t targets = std::min(primitive.targets.size(), weights.size());
    const bool follows = primitive.influences.count > 0 && !joints.empty();
    for (std::size_t vertex = 0; vertex < primitive.positions.size(); ++vertex) {
        const Float3& base = primitive.positions[vertex];
        Double3 point{base[0], base[1], base[2]};
        for (std::size_t target = 0; target < targets; ++target) {
            const std::vector<Float3>& differences = primitive.targets[target].positions;
            for (std::size_t axis = 0; axis < 3 && !differences.empty(); ++axis) {
                point[axis] += weights[target] * differences[vertex][axis];
            }
        }
        positions.push_back(follows ? skinned(primitive.influences, vertex, point, joints) : point);
    }
    return positions;
}

}  // namespace glint::scene_view

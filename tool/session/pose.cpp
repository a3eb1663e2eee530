#include "session/pose.h"

#include "base/lists.h"
#include "base/vectors.h"
#include "gltf/motion/animatable.h"
#include "gltf/motion/transform.h"

#include <algorithm>
#include <cmath>

namespace glint::session {

namespace {

// Two neighbouring keyframes, and the place of a time between them.
struct Segment {
    std::size_t from = 0;
    std::size_t to = 0;    // equal to `from` at a keyframe and outside all of them
    double amount = 0.0;   // [0, 1)
    double seconds = 0.0;  // from one keyframe to the other
};

Segment findSegment(const std::vector<float>& times, double time) {
    const auto after = std::ranges::upper_bound(times, time, {}, [](float t) { return double{t}; });
    const auto next = static_cast<std::size_t>(after - times.begin());
    if (next == 0 || next == times.size()) {
        const std::size_t end = next == 0 ? 0 : next - 1;
        return {end, end, 0.0, 0.0};
    }
    const double begin = times[next - 1];
    const double seconds = times[next] - begin;
    return {next - 1, next, (time - begin) / seconds, seconds};
}

// The three parts of a keyframe of CubicSpline.
enum Part : std::size_t { kInTangent = 0, kValue = 1, kOutTangent = 2 };

double valueAt(const gltf::AnimationSampler& sampler, std::size_t keyframe, std::size_t number,
               Part part = kValue) {
    if (sampler.interpolation == gltf::Interpolation::CubicSpline) {
        return sampler.values[(3 * keyframe + part) * sampler.width + number];
    }
    return sampler.values[keyframe * sampler.width + number];
}

// The formula is in glTF 2.0, appendix C.5.
double cubic(const gltf::AnimationSampler& sampler, const Segment& at, std::size_t number) {
    const double t = at.amount;
    const double t2 = t * t;
    const double t3 = t2 * t;
    return (2.0 * t3 - 3.0 * t2 + 1.0) * valueAt(sampler, at.from, number) +
           at.seconds * (t3 - 2.0 * t2 + t) * valueAt(sampler, at.from, number, kOutTangent) +
           (-2.0 * t3 + 3.0 * t2) * valueAt(sampler, at.to, number) +
           at.seconds * (t3 - t2) * valueAt(sampler, at.to, number, kInTangent);
}

double interpolate(const gltf::AnimationSampler& sampler, const Segment& at, std::size_t number) {
    const double from = valueAt(sampler, at.from, number);
    if (at.from == at.to || sampler.interpolation == gltf::Interpolation::Step) {
        return from;
    }
    if (sampler.interpolation == gltf::Interpolation::CubicSpline) {
        return cubic(sampler, at, number);
    }
    return (1.0 - at.amount) * from + at.amount * valueAt(sampler, at.to, number);
}

// Quaternions of glm have w first, those of glTF have it last.
template <typename NumberAt>
Quaternion quaternionOf(const NumberAt& numberAt) {
    return glm::normalize(Quaternion(numberAt(3), numberAt(0), numberAt(1), numberAt(2)));
}

}  // namespace

// glm::slerp() takes the angle from its cosine, and the arc cosine of a number near 1 has half the digits. So
// this takes it from the chord.
Quaternion slerp(const Quaternion& from, const Quaternion& to, double amount) {
    const Quaternion end = glm::dot(from, to) < 0.0 ? -to : to;
    const double angle = 2.0 * std::asin(std::min(1.0, 0.5 * glm::length(end - from)));
    const double sine = std::sin(angle);
    // Below this, the arc and its chord are equal to the last digit of a double.
    constexpr double kStraight = 1e-8;
    if (sine < kStraight) {
        return glm::normalize(from * (1.0 - amount) + end * amount);
    }
    return glm::normalize(from * (std::sin((1.0 - amount) * angle) / sine) +
                          end * (std::sin(amount * angle) / sine));
}

std::vector<double> sampleNumbers(const gltf::AnimationSampler& sampler, double time) {
    const Segment at = findSegment(sampler.times, time);
    std::vector<double> numbers(sampler.width);
    for (std::size_t i = 0; i < sampler.width; ++i) {
        numbers[i] = interpolate(sampler, at, i);
    }
    return numbers;
}

Quaternion sampleRotation(const gltf::AnimationSampler& sampler, double time) {
    const Segment at = findSegment(sampler.times, time);
    const auto rotationAt = [&](std::size_t keyframe) {
        return quaternionOf([&](std::size_t number) { return valueAt(sampler, keyframe, number); });
    };
    if (at.from == at.to || sampler.interpolation == gltf::Interpolation::Step) {
        return rotationAt(at.from);
    }
    if (sampler.interpolation == gltf::Interpolation::Linear) {
        return slerp(rotationAt(at.from), rotationAt(at.to), at.amount);
    }
    return quaternionOf([&](std::size_t number) { return cubic(sampler, at, number); });
}

namespace {

// Values that animations set, with local transforms in place of the pose's world matrices.
struct Locals {
    std::vector<gltf::Transform> transforms;
    Pose pose;
};

Locals restOf(const gltf::Scene& scene) {
    Locals locals;
    for (const gltf::Node& node : scene.nodes) {
        locals.transforms.push_back(node.rest);
        const bool drawn = node.mesh >= 0;
        locals.pose.weights.push_back(drawn ? node.restWeights : std::vector<double>());
        locals.pose.visible.push_back(node.visible);
    }
    locals.pose.materials =
        base::mapped<materials::Material>(scene.animatedMaterials, &gltf::AnimatedMaterial::rest);
    locals.pose.lights = scene.restLights;
    locals.pose.cameras = scene.restCameras;
    return locals;
}

void applyChannel(const gltf::Animation& animation, const gltf::AnimationChannel& channel, double time,
                  Locals& locals) {
    const gltf::AnimationSampler& sampler = animation.samplers[static_cast<std::size_t>(channel.sampler)];
    const auto target = static_cast<std::size_t>(channel.target);
    if (channel.path == gltf::AnimationPath::Rotation) {
        const Quaternion rotation = sampleRotation(sampler, time);
        locals.transforms[target].rotation = {rotation.x, rotation.y, rotation.z, rotation.w};
        return;
    }
    const std::vector<double> numbers = sampleNumbers(sampler, time);
    switch (channel.path) {
        case gltf::AnimationPath::Translation:
            std::copy_n(numbers.begin(), 3, locals.transforms[target].translation.begin());
            break;
        case gltf::AnimationPath::Scale:
            std::copy_n(numbers.begin(), 3, locals.transforms[target].scale.begin());
            break;
        case gltf::AnimationPath::Rotation:
            break;
        case gltf::AnimationPath::Weights:
            locals.pose.weights[target] = numbers;
            break;
        case gltf::AnimationPath::Weight:
            locals.pose.weights[target][static_cast<std::size_t>(channel.property)] = numbers[0];
            break;
        case gltf::AnimationPath::Visible:
            locals.pose.visible[target] = numbers[0] != 0.0;
            break;
        case gltf::AnimationPath::Material:
            gltf::setMaterialProperty(locals.pose.materials[target], channel.property, numbers);
            break;
        case gltf::AnimationPath::Light:
            setLightProperty(locals.pose.lights[target], channel.property, numbers);
            break;
        case gltf::AnimationPath::Camera:
            setCameraProperty(locals.pose.cameras[target], channel.property, numbers[0]);
            break;
    }
}

Pose poseOf(const gltf::Scene& scene, Locals locals) {
    Pose pose = std::move(locals.pose);
    std::ranges::for_each(pose.lights, gltf::settleLight);
    std::ranges::for_each(pose.cameras, gltf::settleCamera);
    pose.worlds.reserve(scene.nodes.size());
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const gltf::Node& node = scene.nodes[i];
        const gltf::Transform& local = locals.transforms[i];
        const gltf::Matrix4 matrix = node.matrix ? *node.matrix : gltf::compose(local);
        pose.worlds.push_back(
            node.parent < 0 ? matrix
                            : gltf::multiply(pose.worlds[static_cast<std::size_t>(node.parent)], matrix));
    }
    return pose;
}

void placeCamera(const gltf::Matrix4& world, gltf::Camera& camera) {
    if (const std::optional<gltf::Matrix4> rigid = gltf::rigidPart(world)) {
        camera.world = *rigid;
    } else {
        std::copy(world.begin() + 12, world.begin() + 15, camera.world.begin() + 12);
    }
}

void placeLight(const gltf::Matrix4& world, gltf::Light& light) {
    light.position = {world[12], world[13], world[14]};
    if (light.type == gltf::LightType::Point) {
        return;
    }
    if (const std::optional<glm::dvec3> axis = gltf::normalized({-world[8], -world[9], -world[10]})) {
        light.direction = base::toFloat3(*axis);
    }
}

glm::dvec3 skinned(const gltf::SkinInfluences& influences, std::size_t vertex, const glm::dvec3& point,
                   std::span<const gltf::Matrix4> joints) {
    glm::dvec3 sum{};
    for (std::size_t i = vertex * influences.count; i < (vertex + 1) * influences.count; ++i) {
        if (influences.weights[i] == 0.0F) {
            continue;
        }
        sum += double{influences.weights[i]} * base::transformed(joints[influences.joints[i]], point);
    }
    return sum;
}

}  // namespace

Pose restPose(const gltf::Scene& scene) {
    return poseOf(scene, restOf(scene));
}

Pose poseAt(const gltf::Scene& scene, std::span<const std::size_t> animations, double time) {
    Locals locals = restOf(scene);
    for (const std::size_t index : animations) {
        const gltf::Animation& animation = scene.animations[index];
        for (const gltf::AnimationChannel& channel : animation.channels) {
            applyChannel(animation, channel, time, locals);
        }
    }
    return poseOf(scene, std::move(locals));
}

void applyPose(const Pose& pose, gltf::Scene& scene) {
    for (std::size_t i = 0; i < pose.materials.size(); ++i) {
        scene.materials[static_cast<std::size_t>(scene.animatedMaterials[i].material)] = pose.materials[i];
    }
    std::ranges::copy(pose.lights, scene.lights.begin());
    std::ranges::copy(pose.cameras, scene.cameras.begin());
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        gltf::Node& node = scene.nodes[i];
        node.world = pose.worlds[i];
        node.weights = pose.weights[i];
        node.shown =
            pose.visible[i] && (node.parent < 0 || scene.nodes[static_cast<std::size_t>(node.parent)].shown);
        if (node.camera >= 0) {
            placeCamera(node.world, scene.cameras[static_cast<std::size_t>(node.camera)]);
        }
        if (node.light >= 0) {
            gltf::Light& light = scene.lights[static_cast<std::size_t>(node.light)];
            placeLight(node.world, light);
            light.shown = node.shown;
        }
    }
}

void moveTo(const std::optional<Moment>& moment, gltf::Scene& scene) {
    applyPose(moment ? poseAt(scene, moment->animations, moment->seconds) : restPose(scene), scene);
}

std::vector<gltf::Matrix4> jointMatrices(const gltf::Scene& scene, const gltf::Skin& skin) {
    std::vector<gltf::Matrix4> matrices;
    matrices.reserve(skin.joints.size());
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        const gltf::Node& joint = scene.nodes[static_cast<std::size_t>(skin.joints[i])];
        matrices.push_back(gltf::multiply(joint.world, skin.inverseBinds[i]));
    }
    return matrices;
}

std::vector<std::array<double, 3>> deformedPositions(const gltf::Primitive& primitive,
                                                     std::span<const double> weights,
                                                     std::span<const gltf::Matrix4> joints) {
    std::vector<std::array<double, 3>> positions;
    positions.reserve(primitive.positions.size());
    const std::size_t targets = std::min(primitive.targets.size(), weights.size());
    const bool follows = primitive.influences.count > 0 && !joints.empty();
    for (std::size_t vertex = 0; vertex < primitive.positions.size(); ++vertex) {
        glm::dvec3 point = base::toVector(primitive.positions[vertex]);
        for (std::size_t target = 0; target < targets; ++target) {
            const std::vector<gltf::Float3>& differences = primitive.targets[target].positions;
            if (!differences.empty()) {
                point += weights[target] * base::toVector(differences[vertex]);
            }
        }
        positions.push_back(
            base::toArray(follows ? skinned(primitive.influences, vertex, point, joints) : point));
    }
    return positions;
}

std::vector<glm::dvec3> placedPositions(const gltf::Scene& scene, const SceneViewData& view,
                                        std::size_t instance, const gltf::Primitive& primitive) {
    const InstanceView& placed = view.instances[instance];
    const gltf::Node& node = scene.nodes[view.sources[instance].node];
    const bool skinned = !placed.joints.empty();
    const std::vector<gltf::Matrix4> joints =
        skinned ? jointMatrices(scene, scene.skins[static_cast<std::size_t>(node.skin)])
                : std::vector<gltf::Matrix4>();
    // Skinned vertices are in the world already.
    const glm::dvec3 from = base::toVector(skinned ? view.origin : view.meshOrigins[placed.mesh]);
    return base::mapped<glm::dvec3>(
        deformedPositions(primitive, node.weights, joints), [&](const std::array<double, 3>& position) {
            const glm::dvec3 point = base::toVector(position) - from;
            return skinned ? point : base::transformed(placed.objectToWorld, point);
        });
}

}  // namespace glint::session

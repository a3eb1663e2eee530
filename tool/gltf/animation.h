// Plain data that describes what animations change in a scene, with skins and morph targets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glint::gltf {

enum class Interpolation : std::uint8_t { Step, Linear, CubicSpline };
// The property that a channel drives. Only KHR_animation_pointer reaches those after Weights.
enum class AnimationPath : std::uint8_t {
    Translation,
    Rotation,
    Scale,
    Weights,
    Weight,    // the weight of one morph target
    Visible,   // KHR_node_visibility: 0 or 1
    Material,  // these have a row in the tables of gltf/motion/animatable.h
    Light,
    Camera
};

// Returns whether a channel's target is a node, and whether it drives the transform of one.
constexpr bool drivesNode(AnimationPath path) {
    return path <= AnimationPath::Visible;
}
constexpr bool drivesTransform(AnimationPath path) {
    return path <= AnimationPath::Scale;
}

// The keyframes of an animation. A keyframe has as many values as its property has numbers: 1, 2, 3, 4 (a
// colour, or a quaternion x, y, z, w), or one for each morph target.
struct AnimationSampler {
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> times;  // seconds, ascending, finite, at least 0; not empty
    std::size_t width = 0;     // values for each keyframe
    // There are `width` finite values for each keyframe. CubicSpline has 3 * width: in-tangent, value,
    // out-tangent.
    std::vector<float> values;
};

struct AnimationChannel {
    // Index into Scene::nodes, or into Scene::animatedMaterials, lights or cameras. A node whose translation,
    // rotation or scale is animated has no matrix.
    int target = 0;
    AnimationPath path = AnimationPath::Translation;
    int sampler = 0;   // index into Animation::samplers; the sampler is as wide as the property
    int property = 0;  // Weight: the morph target; Material, Light, Camera: the property
};

struct Animation {
    std::string name;
    std::vector<AnimationSampler> samplers;
    std::vector<AnimationChannel> channels;
    double duration = 0.0;  // seconds: the time of the last keyframe of any channel
};

// The number of a joint has 16 bits, which allow no more.
inline constexpr std::size_t kMaxJoints = 65536;

// The joints that a skinned mesh follows.
struct Skin {
    std::string name;
    std::vector<int> joints;                           // indices into Scene::nodes; not empty
    std::vector<std::array<double, 16>> inverseBinds;  // one for each joint, column-major: mesh to joint
};

// Differences to the attributes of a primitive. Each array is empty or as long as the primitive's positions.
struct MorphTarget {
    std::vector<std::array<float, 3>> positions;
    std::vector<std::array<float, 3>> normals;
    std::vector<std::array<float, 3>> tangents;
    std::vector<std::array<float, 4>>
        colors;  // only until the scene is read: Primitive::colors has them then
};

// The joints of a skin that each vertex follows, and their weights.
struct SkinInfluences {
    std::size_t count = 0;              // for each vertex; 0: the primitive follows no skin
    std::vector<std::uint16_t> joints;  // `count` for each vertex: indices into Skin::joints
    std::vector<float> weights;         // `count` for each vertex, at least 0, with a sum of 1
};

}  // namespace glint::gltf

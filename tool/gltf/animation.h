// What animations change in a scene, as plain data; skins and morph targets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glint {

enum class Interpolation : std::uint8_t { Step, Linear, CubicSpline };
// What a channel drives. Below Weights only KHR_animation_pointer reaches it.
enum class AnimationPath : std::uint8_t {
    Translation,
    Rotation,
    Scale,
    Weights,
    Weight,    // of one morph target
    Visible,   // KHR_node_visibility: 0 or 1
    Material,  // these have a row in the tables of gltf/animatable.h
    Light,
    Camera
};

// Keyframes. A keyframe has as many values as its property has numbers: 1, 2, 3, 4 (a colour, or a quaternion
// x, y, z, w), or one for each morph target.
struct AnimationSampler {
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> times;  // seconds, ascending, finite, at least 0; not empty
    std::size_t width = 0;     // values a keyframe
    // width a keyframe; CubicSpline: 3 * width: in-tangent, value, out-tangent. Finite.
    std::vector<float> values;
};

struct AnimationChannel {
    // Index into Scene::nodes, whose transform is no matrix if the path is one of its parts; into
    // Scene::animatedMaterials, lights or cameras.
    int target = 0;
    AnimationPath path = AnimationPath::Translation;
    int sampler = 0;   // index into Animation::samplers; its width is that of the property
    int property = 0;  // Weight: the morph target; Material, Light, Camera: the number of the property
};

struct Animation {
    std::string name;
    std::vector<AnimationSampler> samplers;
    std::vector<AnimationChannel> channels;
    double duration = 0.0;  // seconds: the last keyframe of all channels
};

// What the 16 bits of a joint's number allow.
inline constexpr std::size_t kMaxJoints = 65536;

// The joints that a skinned mesh follows.
struct Skin {
    std::string name;
    std::vector<int> joints;                           // indices into Scene::nodes; not empty
    std::vector<std::array<double, 16>> inverseBinds;  // a joint each, column-major: mesh to joint space
};

// Differences to the attributes of a primitive; each empty or as long as its positions.
struct MorphTarget {
    std::vector<std::array<float, 3>> positions;
    std::vector<std::array<float, 3>> normals;
    std::vector<std::array<float, 3>> tangents;
};

// Which joints of a skin each vertex follows, and how far.
struct SkinInfluences {
    std::size_t count = 0;              // a vertex; 0: the primitive follows no skin
    std::vector<std::uint16_t> joints;  // count a vertex: indices into Skin::joints
    std::vector<float> weights;         // likewise; those of a vertex are at least 0 and sum to 1
};

}  // namespace glint

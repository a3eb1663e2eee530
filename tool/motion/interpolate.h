// The value of an animated property between its keyframes.
#pragma once

#include "gltf/animation.h"

#include <array>
#include <vector>

namespace glint {

using Quaternion = std::array<double, 4>;  // x, y, z, w

// Spherical interpolation of unit quaternions along the shorter arc, `amount` in [0, 1] (glTF 2.0, appendix
// C.4). Opposite ones are the same rotation.
Quaternion slerp(const Quaternion& from, Quaternion to, double amount);

// The values at `time` (seconds), sampler.width of them; before the first keyframe those of the first, after
// the last those of the last. Numbers are interpolated one by one (glTF 2.0, appendix C).
std::vector<double> sampleNumbers(const AnimationSampler& sampler, double time);

// The rotation at `time`, of unit length; `sampler.width` is 4. Linear interpolation is spherical. Nothing is
// known of a rotation of length 0: it is taken as none.
Quaternion sampleRotation(const AnimationSampler& sampler, double time);

}  // namespace glint

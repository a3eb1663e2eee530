// Computes the value of an animated property between its keyframes, and where a pose places vertices.
#pragma once

#include "gltf/animation.h"

#include <glint/session/scene_view.h>

#include <glm/gtc/quaternion.hpp>

#include <cstddef>
#include <vector>

namespace glint::session {

using Quaternion = glm::dquat;

// Interpolates unit quaternions spherically along the shorter arc, with `amount` in [0, 1] (glTF 2.0,
// appendix C.4). Opposite quaternions are the same rotation.
Quaternion slerp(const Quaternion& from, const Quaternion& to, double amount);

// Returns the values at `time` (seconds), sampler.width of them. The first keyframe's values hold before it,
// and the last keyframe's values after it. Numbers are interpolated one by one (glTF 2.0, appendix C).
std::vector<double> sampleNumbers(const gltf::AnimationSampler& sampler, double time);

// Returns the rotation at `time`, which has unit length. `sampler.width` is 4. Linear interpolation is
// spherical. A rotation of length 0 has no meaning, and counts as no rotation.
Quaternion sampleRotation(const gltf::AnimationSampler& sampler, double time);

// Returns the positions of a primitive of an instance at the pose of `scene`, from which `view` was made.
// They are relative to the scene's origin, as lights are.
std::vector<glm::dvec3> placedPositions(const gltf::Scene& scene, const SceneViewData& view,
                                        std::size_t instance, const gltf::Primitive& primitive);

}  // namespace glint::session

// Transforms and lights as the device has them. Pure functions.
#pragma once

#include "interop/scene.h"

#include <glint/scene_view.h>

#include <array>

namespace glint {

// Three rows of four.
using Rows = std::array<float, 12>;

inline gpu::vec3 toVec3(const std::array<float, 3>& v) {
    return {v[0], v[1], v[2]};
}

// Whether the linear part has an inverse that floats can hold: finite, and not flattened.
bool isInvertible(const Rows& objectToWorld);

// The matrices and flags of an instance; finite whenever objectToWorld is.
gpu::InstanceRecord makeInstanceRecord(const Rows& objectToWorld);

// KHR_lights_punctual, "Inner and Outer Cone Angles": the recommended scale and offset.
gpu::LightRecord makeLightRecord(const LightView& light);

}  // namespace glint

// Pure functions that convert transforms and lights to the device's records.
#pragma once

#include "interop/scene.h"

#include <glint/scene_view.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace glint {

// A transform in three rows of four.
using Rows = std::array<float, 12>;

inline gpu::vec3 toVec3(const std::array<float, 3>& v) {
    return {v[0], v[1], v[2]};
}

inline bool isFinite(std::span<const float> values) {
    return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
}

// Returns whether the linear part has an inverse that floats can hold, that is, it is finite and not
// flattened.
bool isInvertible(const Rows& objectToWorld);

// Makes the matrices and flags of an instance. They are finite whenever objectToWorld is.
gpu::InstanceRecord makeInstanceRecord(const Rows& objectToWorld);

// Uses the scale and offset that KHR_lights_punctual recommends in "Inner and Outer Cone Angles".
gpu::LightRecord makeLightRecord(const LightView& light);
std::vector<gpu::LightRecord> makeLightRecords(std::span<const LightView> lights);

}  // namespace glint

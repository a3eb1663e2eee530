// Lets the pure functions of shaders/ compile as C++ in double precision: include this, then the .glsl file
// inside a namespace, then glsl_end.h. GLSL's unsuffixed literals are doubles in C++ already.
#pragma once

#define GLM_FORCE_XYZW_ONLY
#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>

namespace glsl {

using uint = std::uint32_t;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;

using glm::abs;
using glm::clamp;
using glm::cross;
using glm::dot;
using glm::exp;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::pow;
using glm::sqrt;

}  // namespace glsl

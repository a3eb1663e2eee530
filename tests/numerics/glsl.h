// Implements GLSL's types and functions with glm, for shader text that translate.h turned into C++. Define
// GLINT_REAL as float or double, then include this and the text inside namespace glsl. Do so once in a
// translation unit, because all of it has internal linkage.
#pragma once

#ifndef GLINT_REAL
#error "define GLINT_REAL as float or double"
#endif

#ifndef GLM_FORCE_SWIZZLE
#error "define GLM_FORCE_SWIZZLE for the whole translation unit"
#endif

#include <glm/glm.hpp>
#include <glm/gtc/matrix_access.hpp>

#include <bit>
#include <cmath>
#include <cstdint>

namespace glsl {
namespace {

using Real = GLINT_REAL;
using uint = std::uint32_t;
using vec2 = glm::vec<2, Real>;
using vec3 = glm::vec<3, Real>;
using vec4 = glm::vec<4, Real>;
using mat2 = glm::mat<2, 2, Real>;
using mat3 = glm::mat<3, 3, Real>;
using glm::bvec2;
using glm::bvec3;
using glm::bvec4;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;

using glm::abs;
using glm::acos;
using glm::all;
using glm::any;
using glm::asin;
using glm::atan;
using glm::bitfieldReverse;
using glm::ceil;
using glm::clamp;
using glm::cos;
using glm::cross;
using glm::distance;
using glm::dot;
using glm::equal;
using glm::exp;
using glm::exp2;
using glm::floor;
using glm::fract;
using glm::greaterThan;
using glm::greaterThanEqual;
using glm::inversesqrt;
using glm::isinf;
using glm::isnan;
using glm::length;
using glm::lessThan;
using glm::lessThanEqual;
using glm::log;
using glm::log2;
using glm::max;
using glm::min;
using glm::mix;
using glm::mod;
using glm::normalize;
using glm::notEqual;
using glm::pow;
using glm::reflect;
using glm::refract;
using glm::round;
using glm::sign;
using glm::sin;
using glm::smoothstep;
using glm::sqrt;
using glm::step;
using glm::tan;
using glm::transpose;
using glm::trunc;

// This rounds once, like GLSL's fma() on a device with fused multiply-add; glm's fma() does not.
[[maybe_unused]] inline Real fma(Real a, Real b, Real c) {
    return std::fma(a, b, c);
}

template <int n>
glm::vec<n, Real> fma(glm::vec<n, Real> a, glm::vec<n, Real> b, glm::vec<n, Real> c) {
    glm::vec<n, Real> result;
    for (int i = 0; i < n; ++i) {
        result[i] = std::fma(a[i], b[i], c[i]);
    }
    return result;
}

// The bits are those of single precision whatever Real is, because the functions that step through them are
// about single precision. Their arguments are inputs, so they are exact.
[[maybe_unused]] inline int floatBitsToInt(Real value) {
    return std::bit_cast<std::int32_t>(static_cast<float>(value));
}

[[maybe_unused]] inline uint floatBitsToUint(Real value) {
    return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

[[maybe_unused]] inline Real intBitsToFloat(int bits) {
    return std::bit_cast<float>(bits);
}

[[maybe_unused]] inline Real uintBitsToFloat(uint bits) {
    return std::bit_cast<float>(bits);
}

[[maybe_unused]] inline ivec3 floatBitsToInt(vec3 value) {
    return {floatBitsToInt(value.x), floatBitsToInt(value.y), floatBitsToInt(value.z)};
}

[[maybe_unused]] inline vec3 intBitsToFloat(ivec3 bits) {
    return {intBitsToFloat(bits.x), intBitsToFloat(bits.y), intBitsToFloat(bits.z)};
}

}  // namespace
}  // namespace glsl

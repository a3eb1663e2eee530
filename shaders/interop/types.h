// The scalar types that C++ and GLSL share. Every shared structure uses the `scalar` block layout, in which a member is
// aligned to its component. So the C++ structure has the same offsets without padding.
#ifndef GLINT_INTEROP_TYPES_H
#define GLINT_INTEROP_TYPES_H

#ifdef __cplusplus

#include <cstdint>

namespace glint::gpu {
using uint = std::uint32_t;
// NOLINTBEGIN(readability-identifier-naming): these are names of GLSL.
struct vec2 {
    float x, y;
};
struct vec3 {
    float x, y, z;
};
struct vec4 {
    float x, y, z, w;
};
struct uvec2 {
    std::uint32_t x, y;
};
struct uvec4 {
    std::uint32_t x, y, z, w;
};
// NOLINTEND(readability-identifier-naming)
}  // namespace glint::gpu

// A pointer on the device: a buffer of GLSL, which is a type there.
#define GLINT_ADDRESS(buffer) std::uint64_t
#define GLINT_INTEROP_BEGIN namespace glint::gpu {
#define GLINT_INTEROP_END }
#define GLINT_CONSTANT(name, value) inline constexpr std::uint32_t name = value

#else

#define GLINT_ADDRESS(buffer) buffer
#define GLINT_INTEROP_BEGIN
#define GLINT_INTEROP_END
#define GLINT_CONSTANT(name, value) const uint name = value

#endif
#endif

// The bits of Glint's own effects. The product has no names for them; a test compares these with the
// declarations.
#pragma once

#include <glint/internal/package_format.h>

#include <cstdint>

namespace glint::package {

inline constexpr Effect kEffectShadow = 1;
inline constexpr Effect kEffectAmbientOcclusion = 2;
inline constexpr Effect kEffectReflection = 4;
inline constexpr Effect kEffectRefraction = 8;
inline constexpr Effect kEffectIndirectDiffuse = 16;
inline constexpr std::uint32_t kBuiltinEffects = 31;

}  // namespace glint::package

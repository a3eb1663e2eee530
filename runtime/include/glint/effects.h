// The effects that a package may have: what rays do in a picture. One row each; compiler, loader and renderer
// read the same table.
#pragma once

#include <cstdint>
#include <string_view>

namespace glint::package {

// Bits.
enum Effect : std::uint32_t {
    kEffectShadow = 1,            // of punctual lights
    kEffectAmbientOcclusion = 2,  // of the sky's light on primary surfaces
    kEffectReflection = 4,
    kEffectRefraction = 8,
    kEffectIndirectDiffuse = 16,  // one bounce, in the place of the sky's light
    kAllEffects = 31,
};

enum class EffectKind : std::uint8_t {
    Light,    // decides what of a light reaches a surface, primary or hit
    Surface,  // decides what of the sky's light reaches a primary surface
    Rays,     // sends rays from primary surfaces whose hits the package shades
};

struct EffectInfo {
    Effect effect;
    EffectKind kind;
    bool screenStart;       // its rays have a beginning of their own: FILE_start.glsl
    std::string_view name;  // on the command line, in the manifest, of passes
    // In the names of files (shaders/effects/) and of functions.
    std::string_view file;
    std::string_view function;
};

// In order of their bits. To add an effect: a row here, its bit in shaders/interop/frame.h, a rule in
// tool/plan/effects.cpp, and its files of shaders/effects; docs/effects.md shows one.
inline constexpr EffectInfo kEffects[] = {
    {kEffectShadow, EffectKind::Light, false, "shadow", "shadow", "Shadow"},
    {kEffectAmbientOcclusion, EffectKind::Surface, false, "ambient-occlusion", "ambient_occlusion",
     "AmbientOcclusion"},
    {kEffectReflection, EffectKind::Rays, true, "reflection", "reflection", "Reflection"},
    {kEffectRefraction, EffectKind::Rays, false, "refraction", "refraction", "Refraction"},
    {kEffectIndirectDiffuse, EffectKind::Rays, false, "indirect-diffuse", "indirect_diffuse",
     "IndirectDiffuse"},
};
inline constexpr std::uint32_t kEffectCount = 5;

// Place in kEffects: the number of the effect's bit. `effect` is one bit of kAllEffects.
constexpr std::uint32_t effectNumber(Effect effect) {
    std::uint32_t number = 0;
    while ((std::uint32_t{1} << number) != effect) {
        ++number;
    }
    return number;
}

constexpr const EffectInfo& effectInfo(Effect effect) {
    return kEffects[effectNumber(effect)];
}

constexpr std::string_view nameOf(Effect effect) {
    return effectInfo(effect).name;
}

// The bits of `effects` that send rays whose hits are shaded.
constexpr std::uint32_t rayEffects(std::uint32_t effects) {
    std::uint32_t result = 0;
    for (const EffectInfo& info : kEffects) {
        result |= info.kind == EffectKind::Rays ? effects & info.effect : 0U;
    }
    return result;
}

// How many effects of a package send rays, and the place of one among them.
constexpr std::uint32_t rayEffectCount(std::uint32_t effects) {
    std::uint32_t count = 0;
    for (std::uint32_t rest = rayEffects(effects); rest != 0; rest &= rest - 1) {
        ++count;
    }
    return count;
}
constexpr std::uint32_t effectSlot(std::uint32_t effects, Effect effect) {
    return rayEffectCount(effects & (effect - 1U));
}

}  // namespace glint::package

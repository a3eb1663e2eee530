// The effects that a package may have, that is, what rays add to a picture. A table has one row for each
// effect; compiler, loader and renderer all read it.
#pragma once

#include <cstdint>
#include <string_view>

namespace glint::package {

// Effects as bits of a set.
enum Effect : std::uint32_t {
    kEffectShadow = 1,            // shadows of punctual lights
    kEffectAmbientOcclusion = 2,  // occlusion of the sky's light on primary surfaces
    kEffectReflection = 4,
    kEffectRefraction = 8,
    kEffectIndirectDiffuse = 16,  // one bounce, which replaces the sky's light
    kAllEffects = 31,
};

enum class EffectKind : std::uint8_t {
    Light,    // decides how much of a light reaches a surface, primary or hit
    Surface,  // decides how much of the sky's light reaches a primary surface
    Rays,     // sends rays from primary surfaces whose hits the package shades
};

struct EffectInfo {
    Effect effect;
    EffectKind kind;
    bool screenStart;       // its rays start with a march in screen space: FILE_start.glsl
    std::string_view name;  // name on the command line, in the manifest and of passes
    // Parts of the names of files (in shaders/effects/) and of functions.
    std::string_view file;
    std::string_view function;
};

// The effects in the order of their bits. To add an effect, add a row here, its bit in
// shaders/interop/frame.h, a rule in tool/plan/effects.cpp and its files in shaders/effects. docs/effects.md
// shows an example.
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

// Returns the index of an effect in kEffects, which is the number of its bit. `effect` must be one bit of
// kAllEffects.
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

// Returns the bits of `effects` that send rays whose hits are shaded.
constexpr std::uint32_t rayEffects(std::uint32_t effects) {
    std::uint32_t result = 0;
    for (const EffectInfo& info : kEffects) {
        result |= info.kind == EffectKind::Rays ? effects & info.effect : 0U;
    }
    return result;
}

// rayEffectCount() says how many of `effects` send rays. effectSlot() is the index of one effect among them.
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

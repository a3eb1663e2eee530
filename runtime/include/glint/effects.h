// The effects of packages, that is, the uses of rays in a picture. Each is declared by a folder of
// shaders/effects or of a pack (docs/effects.md); a package says which it has.
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

namespace glint::package {

// One bit of a set of effects. The compiler numbers the effects, and a package keeps the numbers. Effects of
// Glint's own have the same bit in every package. Package::effects() gives their names.
using Effect = std::uint32_t;

inline constexpr std::uint32_t kMostEffects = 32;
inline constexpr std::uint32_t kAllEffects = 0xFFFFFFFFU;

enum class EffectKind : std::uint32_t {
    Light = 0,    // decides how much of a light reaches a surface, primary or hit
    Surface = 1,  // decides how much of the sky's light reaches a primary surface
    Rays = 2,     // sends rays from primary surfaces whose hits the package shades
};

// The work that the renderer does for an effect beyond its kind, as bits of a set.
enum EffectAbility : std::uint32_t {
    kEffectStartsOnScreen = 1,  // its rays may find their end in the picture: it keeps positions of pixels
    kEffectWalks = 2,           // a pass of its own follows its rays before the list takes them
    kAllEffectAbilities = 3,
};

// An effect of a package.
struct EffectInfo {
    Effect effect = 0;
    EffectKind kind = EffectKind::Rays;
    std::uint32_t abilities = 0;  // EffectAbility bits
    std::string_view name{};      // on the command line, in the manifest and of passes
};

// The effects of a package as sets of bits, grouped by the renderer's work.
struct EffectSet {
    std::uint32_t all = 0;
    // The effects of each kind.
    std::uint32_t lights = 0;
    std::uint32_t surfaces = 0;
    std::uint32_t rays = 0;
    // The effects of each ability.
    std::uint32_t screenStarts = 0;
    std::uint32_t walks = 0;

    constexpr void add(const EffectInfo& info) {
        all |= info.effect;
        (info.kind == EffectKind::Light     ? lights
         : info.kind == EffectKind::Surface ? surfaces
                                            : rays) |= info.effect;
        screenStarts |= (info.abilities & kEffectStartsOnScreen) != 0 ? info.effect : 0U;
        walks |= (info.abilities & kEffectWalks) != 0 ? info.effect : 0U;
    }
    // Returns whether a pass other than those that shade hits traces rays.
    constexpr bool tracesAtSurfaces() const {
        return (lights | surfaces) != 0;
    }
    friend bool operator==(const EffectSet&, const EffectSet&) = default;
};

// Returns the number of an effect's bit.
constexpr std::uint32_t effectNumber(Effect effect) {
    return static_cast<std::uint32_t>(std::countr_zero(effect));
}

// effectSlot() is the index of an effect that sends rays among those of the package. effectSlots() is their
// number.
constexpr std::uint32_t effectSlot(const EffectSet& effects, Effect effect) {
    return static_cast<std::uint32_t>(std::popcount(effects.rays & (effect - 1U)));
}
constexpr std::uint32_t effectSlots(const EffectSet& effects) {
    return static_cast<std::uint32_t>(std::popcount(effects.rays));
}

// The number of effects that have counters: up to the last one of the package.
constexpr std::uint32_t countedEffects(const EffectSet& effects) {
    return static_cast<std::uint32_t>(std::bit_width(effects.all));
}

// Calls `visit` with the number of each effect of a set, ascending.
template <typename Visit>
constexpr void forEachEffect(std::uint32_t effects, const Visit& visit) {
    for (std::uint32_t rest = effects; rest != 0; rest &= rest - 1) {
        visit(effectNumber(rest));
    }
}

}  // namespace glint::package

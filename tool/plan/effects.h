// Which effects a package has: what is asked for, and what the scenes call for. Pure functions.
#pragma once

#include "plan/material.h"

#include <glint/effects.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint {

// What the user asks for.
struct EffectRequest {
    bool automatic = false;   // those that the scenes call for
    std::uint32_t named = 0;  // Effect bits: those in any case
    // Surfaces with a greater roughness send no reflection ray: FrameOptions::maxReflectionRoughness.
    float maxReflectionRoughness = 0.3F;
};

// What of a scene decides, apart from its materials.
struct SceneLights {
    bool lit = false;  // some light has an intensity
};

struct EffectDecision {
    package::Effect effect{};
    bool chosen = false;
    bool usable = false;  // the scenes call for it
    std::string reason;
};

struct EffectPlan {
    std::uint32_t effects = package::kEffectShadow | package::kEffectReflection;  // Effect bits
    std::vector<EffectDecision> decisions;  // one for each of package::kEffects, in their order
};

// `materials`: those that primitives use, not null. Reasons are of values, not of the presence of an
// extension.
EffectPlan decideEffects(std::span<const Material* const> materials, const SceneLights& lights,
                         const EffectRequest& request);

// Whether pixels of this material send rays of an effect of the kind Rays, as far as its factors tell: a
// texture may make some of it rougher, or black.
bool sendsRays(package::Effect effect, const Material& material, float maxReflectionRoughness);

}  // namespace glint

// Decides which effects a package has, from what the user asks for and what the scenes call for. Pure
// functions.
#pragma once

#include "materials/material.h"

#include <glint/effects.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint {

// What the user asks for.
struct EffectRequest {
    bool automatic = false;   // chooses those that the scenes call for
    std::uint32_t named = 0;  // Effect bits: always chosen
    // Surfaces that are rougher than this send no reflection ray: FrameOptions::maxReflectionRoughness.
    float maxReflectionRoughness = 0.3F;
};

// The facts about a scene that decide, apart from its materials.
struct SceneLights {
    bool lit = false;  // Some light has an intensity above 0.
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

// Only the materials of `primitives` count. Requires every PrimitiveInputs::material to index `materials`.
// The reasons name values, not extensions that are merely present.
EffectPlan decideEffects(std::span<const Material> materials, std::span<const PrimitiveInputs> primitives,
                         const SceneLights& lights, const EffectRequest& request);

// Returns whether pixels of this material on this primitive may send rays of an effect of the kind Rays. A
// texture may make parts of it rougher or black.
bool sendsRays(package::Effect effect, const Material& material, const PrimitiveInputs& primitive,
               float maxReflectionRoughness);

// Returns the least roughness of anything that reflects, without what textures do; infinity if nothing does.
double leastRoughness(const Material& material, const PrimitiveInputs& primitive);

}  // namespace glint

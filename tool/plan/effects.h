// Decides which effects a package has, from the user's request and the scenes' needs. Pure functions.
#pragma once

#include "materials/material.h"

#include <glint/internal/package_format.h>

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// The user's request.
struct EffectRequest {
    bool automatic = false;   // chooses those that the scenes call for
    std::uint32_t named = 0;  // Effect bits: always chosen
    // Surfaces that are rougher than this send no reflection ray: FrameOptions::maxReflectionRoughness.
    float maxReflectionRoughness = 0.3F;
    // Effects of packs that are always chosen, by name, because their bits are known only once the packs are
    // read.
    std::vector<std::string> ofPacks{};
};

// The facts about a scene, apart from its materials, on which the decision depends.
struct SceneLights {
    bool lit = false;  // Some light has an intensity above 0.
};

struct EffectDecision {
    package::Effect effect = 0;
    std::string name{};
    bool isNamed = false;  // the user asks for it by name
    bool chosen = false;
    bool usable = false;  // the scenes call for it
    std::string reason;
};

struct EffectPlan {
    package::EffectSet effects{};
    std::vector<EffectDecision> decisions{};  // one for each effect of the model, in their order
};

// Returns the bits of effects of Glint's own.
std::uint32_t builtinEffects(std::initializer_list<std::string_view> names);

// Only the materials of `primitives` count. Requires every PrimitiveInputs::material to index `materials`.
// The reasons name values rather than the presence of extensions. The effects are those of the materials'
// model. The names of `request` must be among them.
EffectPlan decideEffects(std::span<const materials::Material> materials,
                         std::span<const materials::PrimitiveInputs> primitives, const SceneLights& lights,
                         const EffectRequest& request);

// Returns whether pixels of this material on this primitive may send rays of an effect of the kind Rays. A
// texture may make parts of it rougher or black.
bool sendsRays(const materials::EffectDeclaration& effect, const materials::Material& material,
               const materials::PrimitiveInputs& primitive, float maxReflectionRoughness);

// Returns whether triangles of this material on this primitive can be lights: they emit light, and no code of
// a pack changes that light or the place at which its texture is read.
bool isEmitter(const materials::Material& material, const materials::PrimitiveInputs& primitive);

// Returns whether light may pass straight through the surface.
bool passesLight(const materials::Material& material, const materials::PrimitiveInputs& primitive);

// Returns the least roughness of anything that reflects, without the effects of textures; infinity if nothing
// reflects.
double leastRoughness(const materials::Material& material, const materials::PrimitiveInputs& primitive);

}  // namespace glint::compiler

// The effects of a package, and the GLSL that calls them.
#pragma once

#include "emit/compile.h"
#include "gltf/scene_list.h"
#include "plan/effects.h"

#include <kainjow/mustache.hpp>

#include <string>

namespace glint {

// Decides by the materials that primitives use, and by the lights.
EffectPlan planEffects(const SceneList& scenes, const CompileSettings& settings);

// Returns the effects' macros for generated/scene.glsl.
std::string effectDefines(std::uint32_t effects);

// Adds the fields for effects.glsl.mustache and compose_effects.glsl.mustache.
void addEffects(kainjow::mustache::data& context, std::uint32_t effects);
// Adds the fields for effect_rays.comp.mustache: one effect that sends rays.
void addEffect(kainjow::mustache::data& context, std::uint32_t effects, package::Effect effect);

}  // namespace glint

// The effects of a package in its sources: which there are, and the GLSL that calls them.
#pragma once

#include "emit/compile.h"
#include "gltf/scene_list.h"
#include "plan/effects.h"

#include <kainjow/mustache.hpp>

#include <string>

namespace glint {

// By the materials that primitives use, and the lights.
EffectPlan planEffects(const SceneList& scenes, const CompileSettings& settings);

// Macros of generated/scene.glsl.
std::string effectDefines(std::uint32_t effects);

// For effects.glsl.mustache and compose_effects.glsl.mustache.
void addEffects(kainjow::mustache::data& context, std::uint32_t effects);
// For effect_rays.comp.mustache: one effect that sends rays.
void addEffect(kainjow::mustache::data& context, std::uint32_t effects, package::Effect effect);

}  // namespace glint

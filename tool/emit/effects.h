// The GLSL that calls the effects of a package.
#pragma once

#include "plan/plan.h"

#include <kainjow/mustache.hpp>

#include <string>

namespace glint::compiler {

// Returns the effects' macros and bits for generated/scene.glsl.
std::string effectDefines(const materials::MaterialModel& model, const package::EffectSet& effects);

// Adds the fields for the templates that call the effects of a package.
void addEffects(kainjow::mustache::data& context, const Plan& plan);
// Adds the fields for effect_rays.comp.mustache: the effect with that number, which sends rays.
void addEffect(kainjow::mustache::data& context, const materials::MaterialModel& model,
               const package::EffectSet& effects, std::size_t number);

}  // namespace glint::compiler

// The GLSL that calls the effects of a package and writes its layers.
#pragma once

#include "plan/plan.h"

#include <kainjow/mustache.hpp>

#include <string>

namespace glint::compiler {

// Returns the layers' macros for generated/scene.glsl. `deforms`: some vertices follow joints or morph
// weights. `findsSizedLights`: rays find lights with a size, which walks may meet.
std::string layerDefines(const Plan& plan, bool deforms, bool findsSizedLights);

// Adds the fields for the templates of layers: surface_layers.glsl, compose_effects.glsl.
void addLayers(kainjow::mustache::data& context, const Plan& plan);
// Adds the fields of one effect's layers to its entry in compose_effects.glsl.mustache.
void addLayersOf(kainjow::mustache::data& entry, const Plan& plan, package::Effect effect);

// --- The GLSL that calls the effects of a package ---

// Returns the effects' macros and bits for generated/scene.glsl.
std::string effectDefines(const materials::MaterialModel& model, const package::EffectSet& effects);

// Adds the fields for the templates that call the effects of a package.
void addEffects(kainjow::mustache::data& context, const Plan& plan);
// Adds the fields for effect_rays.comp.mustache: the effect with that number, which sends rays.
void addEffect(kainjow::mustache::data& context, const materials::MaterialModel& model,
               const package::EffectSet& effects, std::size_t number);

}  // namespace glint::compiler

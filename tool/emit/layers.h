// The layers of a package, and the GLSL that writes them.
#pragma once

#include "emit/compile.h"
#include "plan/plan.h"

#include <glint/layers.h>
#include <glint/result.h>

#include <kainjow/mustache.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// Returns the layers that CompileSettings::layers names, with those that they are computed from, in the order
// of their images: that of the table, then that of effects. Errors: "layer-effect" (a layer of an effect that
// the package lacks), "passes" (the package draws no frame). Requires plan.effects.
Result<std::vector<package::LayerEntry>> resolveLayers(const Plan& plan, const CompileSettings& settings,
                                                       const std::string& where);

// Returns the name of a layer of a package: "depth", "reflection.radiance".
std::string layerNameOf(const package::LayerEntry& entry, const materials::MaterialModel& model);

// Returns the layers' macros for generated/scene.glsl. `deforms`: some vertices follow joints or morph
// weights. `findsSizedLights`: rays find lights with a size, which walks may meet.
std::string layerDefines(const Plan& plan, bool deforms, bool findsSizedLights);

// Adds the fields for the templates of layers: surface_layers.glsl, compose_effects.glsl.
void addLayers(kainjow::mustache::data& context, const Plan& plan);
// Adds the fields of one effect's layers to its entry in compose_effects.glsl.mustache.
void addLayersOf(kainjow::mustache::data& entry, const Plan& plan, package::Effect effect);

}  // namespace glint::compiler

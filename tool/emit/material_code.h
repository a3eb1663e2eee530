// The generated GLSL that calls the code of material features.
#pragma once

#include "emit/sources.h"
#include "materials/material_model.h"

#include <glint/result.h>

namespace glint {

// Adds "generated/layers.glsl", "layers_sky.glsl", "layers_traced.glsl" and "material_stages.glsl" for the
// features of `used`. Has the errors of renderTemplate().
Status addMaterialCode(SourceSet& sources, const MaterialModel& model, FeatureMask used);

}  // namespace glint

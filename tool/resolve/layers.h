// The layers of a package.
#pragma once

#include "plan/plan.h"
#include "settings/settings.h"

#include <glint/layers.h>
#include <glint/result.h>

#include <string>
#include <vector>

namespace glint::compiler {

// Returns the layers that CompileSettings::layers names, with those that they are computed from, in the order
// of their images: that of the table, then that of effects. Errors: "layer-effect" (a layer of an effect that
// the package lacks), "passes" (the package draws no frame). Requires plan.effects.
Result<std::vector<package::LayerEntry>> resolveLayers(const Plan& plan, const CompileSettings& settings,
                                                       const std::string& where);

// Returns the name of a layer of a package: "depth", "reflection.radiance".
std::string layerNameOf(const package::LayerEntry& entry, const materials::MaterialModel& model);

const package::LayerInfo& infoOf(const package::LayerEntry& entry);
const materials::EffectDeclaration& declarationOf(const materials::MaterialModel& model,
                                                  package::Effect effect);
// Returns the albedo that the light of a source is divided by: that of the lobes that bring it.
const package::LayerInfo& albedoOf(package::Effect effect, const materials::MaterialModel& model);
bool demodulates(const package::LayerInfo& info);

}  // namespace glint::compiler

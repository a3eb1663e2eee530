// What commands say about the effects of scenes.
#pragma once

#include "emit/compile.h"
#include "gltf/scene_list.h"

#include <string>
#include <vector>

namespace glint::cli {

// Returns a warning for each effect that is asked for although the scenes can't use it.
std::vector<Diagnostic> effectWarnings(const gltf::SceneList& scenes,
                                       const compiler::CompileSettings& settings);

// Returns the decisions of --effects auto, for the lights that the scenes have.
compiler::EffectPlan automaticEffects(const gltf::SceneList& scenes);
// Returns a line for each effect: whether it is chosen, and why.
std::string effectsText(const compiler::EffectPlan& plan);

}  // namespace glint::cli

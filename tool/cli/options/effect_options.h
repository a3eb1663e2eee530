// What commands say about the effects of scenes.
#pragma once

#include "emit/compile.h"
#include "gltf/scene_list.h"

#include <string>
#include <vector>

namespace glint {

// Returns a warning for each effect that is asked for although the scenes can't use it.
std::vector<Diagnostic> effectWarnings(const SceneList& scenes, const CompileSettings& settings);

// Returns the decisions of --effects auto, for the lights that the scenes have.
EffectPlan automaticEffects(const SceneList& scenes);
// Returns a line for each effect: whether it is chosen, and why.
std::string effectsText(const EffectPlan& plan);

}  // namespace glint

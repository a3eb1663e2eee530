// Options of effects: which effects a package has, and how a renderer runs them.
#pragma once

#include "cli/options/options.h"
#include "gltf/scene_list.h"

#include <string>
#include <vector>

namespace glint {

// Adds --effects and --max-roughness. Returns --effects.
CLI::Option& addEffectOptions(CLI::App& command, measure::EffectSettings& arguments);
// Throws a CLI::ParseError if "none" or "all" stands among others.
void checkEffects(const measure::EffectSettings& arguments);

// Returns a warning for each effect that is asked for although the scenes can't use it.
std::vector<Diagnostic> effectWarnings(const SceneList& scenes, const CompileSettings& settings);

// Returns the decisions of --effects auto, for the lights that the scenes have.
EffectPlan automaticEffects(const SceneList& scenes);
// Returns a line for each effect: whether it is chosen, and why.
std::string effectsText(const EffectPlan& plan);

// The settings that a renderer chooses.
void addEffectFrameOptions(CLI::App& command, measure::EffectFrameSettings& arguments);
// Throws a CLI::ParseError if options contradict each other.
void checkEffectFrame(const measure::EffectFrameSettings& arguments);

}  // namespace glint

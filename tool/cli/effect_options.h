// Options of effects: which effects a package has, and how a renderer runs them.
#pragma once

#include "cli/options.h"
#include "cli/scene_view.h"
#include "gltf/scene_list.h"

#include <glint/renderer.h>

#include <string>
#include <vector>

namespace glint {

// The effects of a package.
struct EffectArguments {
    std::vector<std::string> effects{"auto"};
    double maxRoughness = 0.3;
    void apply(CompileSettings& settings) const;
};
// Adds --effects and --max-roughness. Returns --effects.
CLI::Option& addEffectOptions(CLI::App& command, EffectArguments& arguments);
// Throws a CLI::ParseError if "none" or "all" stands among others.
void checkEffects(const EffectArguments& arguments);

// Returns a warning for each effect that is asked for although the scenes can't use it.
std::vector<Diagnostic> effectWarnings(const SceneList& scenes, const CompileSettings& settings);

// Returns the decisions of --effects auto, for the lights that the scenes have.
EffectPlan automaticEffects(const SceneList& scenes);
// Returns a line for each effect: whether it is chosen, and why.
std::string effectsText(const EffectPlan& plan);

// The settings that a renderer chooses.
struct EffectFrameArguments {
    double skipBelow = 0.0;
    std::int64_t shadowSamples = 1;
    double lightRadius = 0.0;  // metres
    double sunAngle = 0.0;     // degrees
    std::int64_t occlusionSamples = 4;
    double occlusionRadius = 0.0;  // metres; 0: unlimited
    std::string occlusionFalloff = "none";
    std::int64_t maxInterfaces = 8;
    bool batch = false;
    void apply(RendererOptions& options) const;
    void apply(FrameOptions& frame) const;
    void apply(SceneViewData& scene) const;
};
void addEffectFrameOptions(CLI::App& command, EffectFrameArguments& arguments);
// Throws a CLI::ParseError if options contradict each other.
void checkEffectFrame(const EffectFrameArguments& arguments);

}  // namespace glint

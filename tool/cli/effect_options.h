// Options of effects: which a package has, and how a renderer runs them.
#pragma once

#include "cli/options.h"
#include "cli/scene_view.h"
#include "gltf/scene_list.h"

#include <glint/renderer.h>

#include <string>
#include <vector>

namespace glint {

// What a package has.
struct EffectArguments {
    std::vector<std::string> effects{"auto"};
    double maxRoughness = 0.3;
    void apply(CompileSettings& settings) const;
};
// --effects, --max-roughness. Returns --effects.
CLI::Option& addEffectOptions(CLI::App& command, EffectArguments& arguments);
// Throws a CLI::ParseError where "none" or "all" stands among others.
void checkEffects(const EffectArguments& arguments);

// One for each effect that is asked for and that the scenes can't use.
std::vector<Diagnostic> effectWarnings(const SceneList& scenes, const CompileSettings& settings);

// The decisions of --effects auto, with the lights that the scenes have.
EffectPlan automaticEffects(const SceneList& scenes);
// A line for each effect: whether it is chosen, and why.
std::string effectsText(const EffectPlan& plan);

// What a renderer chooses.
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
// Throws a CLI::ParseError where options disagree.
void checkEffectFrame(const EffectFrameArguments& arguments);

}  // namespace glint

#include "cli/options/effect_options.h"

#include "cli/table.h"
#include "emit/effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glint {

namespace {

constexpr const char* kAutomatic = "auto";
constexpr const char* kNoEffects = "none";
constexpr const char* kEverything = "all";
constexpr double kMaxMetres = 1e6;

std::vector<std::string> effectChoices() {
    std::vector<std::string> choices{kAutomatic, kNoEffects, kEverything};
    for (const package::EffectInfo& info : package::kEffects) {
        choices.emplace_back(info.name);
    }
    return choices;
}

}  // namespace

CLI::Option& addEffectOptions(CLI::App& command, measure::EffectSettings& arguments) {
    CLI::Option& effects = addChoices(command, "--effects", arguments.effects, effectChoices(),
                                      "which effects the package has, separated by commas; auto:\n"
                                      "shadow, reflection and refraction, where the scene calls\n"
                                      "for them; ambient-occlusion and indirect-diffuse have to\n"
                                      "be named; none; all");
    effects.type_name("auto|none|all|LIST")->group("Effects");
    addReal(command, "--max-roughness", arguments.maxRoughness, 0.0, 1.0,
            "rougher surfaces send no reflection ray\n(0 to 1, default: 0.3)")
        .group("Effects");
    return effects;
}

void checkEffects(const measure::EffectSettings& arguments) {
    for (const char* const alone : {kNoEffects, kEverything}) {
        const bool named = std::ranges::find(arguments.effects, alone) != arguments.effects.end();
        if (named && arguments.effects.size() > 1) {
            throw CLI::ValidationError(
                "--effects",
                std::string(alone) + " can't be combined with other effects; leave out one or the others");
        }
    }
}

std::vector<Diagnostic> effectWarnings(const SceneList& scenes, const CompileSettings& settings) {
    std::vector<Diagnostic> warnings;
    if (settings.effects.named == package::kAllEffects) {
        return warnings;  // "all" asks for none of them by name
    }
    for (const EffectDecision& decision : planEffects(scenes, settings).decisions) {
        if ((settings.effects.named & decision.effect) != 0 && !decision.usable) {
            warnings.push_back(makeWarning(
                "effect-unused", scenes.path(),
                fmt::format("the effect {} is {}", package::nameOf(decision.effect), decision.reason),
                "leave it out of --effects: its passes cost time and change nothing"));
        }
    }
    return warnings;
}

EffectPlan automaticEffects(const SceneList& scenes) {
    CompileSettings settings;
    measure::EffectSettings{}.apply(settings);
    return planEffects(scenes, settings);
}

std::string effectsText(const EffectPlan& plan) {
    std::vector<std::vector<std::string>> rows{{"effect", "auto", "why"}};
    for (const EffectDecision& decision : plan.decisions) {
        rows.push_back(
            {std::string(package::nameOf(decision.effect)), decision.chosen ? "yes" : "no", decision.reason});
    }
    return formatTable(rows);
}

void addEffectFrameOptions(CLI::App& command, measure::EffectFrameSettings& arguments) {
    const std::string group = "Effects";
    addReal(command, "--skip-below", arguments.skipBelow, 0.0, 1.0,
            "do not send rays whose weight is below X; their light is\n"
            "lost (0 to 1, default: 0, every ray is sent)")
        .group(group);
    addReal(command, "--light-radius", arguments.lightRadius, 0.0, kMaxMetres,
            "radius of point and spot lights in metres, for soft\n"
            "shadows (0 to 1e6, default: 0, hard shadows)")
        .group(group);
    addReal(command, "--sun-angle", arguments.sunAngle, 0.0, 90.0,
            "angular diameter of directional lights in degrees; the\n"
            "sun has 0.53 (0 to 90, default: 0, hard shadows)")
        .group(group);
    addInteger(command, "--shadow-spp", arguments.shadowSamples, 1, 4096,
               "shadow rays per sample to each light that has a size")
        .group(group);
    addReal(command, "--ao-radius", arguments.occlusionRadius, 0.0, kMaxMetres,
            "how far ambient-occlusion looks, in metres (0 to 1e6,\n"
            "default: 0, without a limit)")
        .group(group);
    addChoice(command, "--ao-falloff", arguments.occlusionFalloff, {"none", "linear"},
              "linear: surfaces occlude less the farther away they are;\n"
              "needs --ao-radius")
        .group(group);
    addInteger(command, "--ao-spp", arguments.occlusionSamples, 1, 4096,
               "rays per sample of ambient-occlusion")
        .group(group);
    addInteger(command, "--max-interfaces", arguments.maxInterfaces, 1, 64,
               "the most surfaces that a refracted ray meets")
        .group(group);
    addFlag(command, "--batch-effects", arguments.batch,
            "shade the hits of all effects together: fewer and larger\ndispatches, more memory")
        .group(group);
}

void checkEffectFrame(const measure::EffectFrameSettings& arguments) {
    if (arguments.occlusionFalloff == "linear" && arguments.occlusionRadius <= 0.0) {
        throw CLI::ValidationError("--ao-falloff", "linear needs a radius; give one with --ao-radius");
    }
}

}  // namespace glint

#include "cli/options/effect_options.h"

#include "cli/table.h"
#include "emit/effects.h"
#include "settings/settings.h"

#include <fmt/format.h>

namespace glint::cli {

std::vector<Diagnostic> effectWarnings(const gltf::SceneList& scenes,
                                       const compiler::CompileSettings& settings) {
    std::vector<Diagnostic> warnings;
    for (const compiler::EffectDecision& decision : planEffects(scenes, settings).decisions) {
        if (decision.isNamed && !decision.usable) {
            warnings.push_back(
                makeWarning("effect-unused", scenes.path(),
                            fmt::format("the effect {} is {}", decision.name, decision.reason),
                            "leave it out of --effects: its passes cost time and change nothing"));
        }
    }
    return warnings;
}

compiler::EffectPlan automaticEffects(const gltf::SceneList& scenes) {
    return planEffects(scenes, compiler::Settings().compile);
}

std::string effectsText(const compiler::EffectPlan& plan) {
    std::vector<std::vector<std::string>> rows{{"effect", "auto", "why"}};
    for (const compiler::EffectDecision& decision : plan.decisions) {
        rows.push_back({decision.name, decision.chosen ? "yes" : "no", decision.reason});
    }
    return formatTable(rows);
}

}  // namespace glint::cli

#include "cli/options/effect_options.h"

#include "cli/table.h"
#include "emit/effects.h"
#include "settings/settings.h"

#include <fmt/format.h>

namespace glint {

std::vector<Diagnostic> effectWarnings(const SceneList& scenes, const CompileSettings& settings) {
    std::vector<Diagnostic> warnings;
    for (const EffectDecision& decision : planEffects(scenes, settings).decisions) {
        if (decision.isNamed && !decision.usable) {
            warnings.push_back(
                makeWarning("effect-unused", scenes.path(),
                            fmt::format("the effect {} is {}", decision.name, decision.reason),
                            "leave it out of --effects: its passes cost time and change nothing"));
        }
    }
    return warnings;
}

EffectPlan automaticEffects(const SceneList& scenes) {
    return planEffects(scenes, Settings().compile);
}

std::string effectsText(const EffectPlan& plan) {
    std::vector<std::vector<std::string>> rows{{"effect", "auto", "why"}};
    for (const EffectDecision& decision : plan.decisions) {
        rows.push_back({decision.name, decision.chosen ? "yes" : "no", decision.reason});
    }
    return formatTable(rows);
}

}  // namespace glint

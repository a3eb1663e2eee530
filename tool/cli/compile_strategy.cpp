#include "cli/compile_strategy.h"

#include "cli/strategy_advice.h"
#include "emit/effects.h"

#include <algorithm>
#include <utility>

namespace glint {

Status settleStrategies(const SceneList& scenes, const PlanOptions& plan, CompileArguments& arguments) {
    std::vector<std::string>& names = arguments.tracing.strategies;
    const auto automatic = std::ranges::find(names, kAutoStrategy);
    if (automatic == names.end()) {
        return okStatus();
    }
    const Result<KnownCosts> costs = knownCosts(arguments.calibration, false);
    if (!costs) {
        return costs.error();
    }
    FrameShape shape;
    shape.effects = planEffects(scenes, settingsOf(arguments, plan)).effects;
    shape.maxReflectionRoughness = static_cast<float>(arguments.effects.maxRoughness);
    const Plan made = makePlan(scenes.materials(), scenes.primitives(), plan);
    Result<StrategyAdvice> advice =
        adviseStrategy(*costs, roundsOf(scenes, made, plan, shape),
                       runnableStrategies(package::kAllTracers, std::nullopt, nullptr), shape.pixels);
    if (!advice) {
        return advice.error();
    }
    *automatic = advice->choice.strategy;
    if (strategyNamed(advice->choice.strategy) == package::kStrategyHitShaders) {
        names.emplace_back(package::nameOf(package::kStrategyUber));
    }
    arguments.tracing.advice = std::move(*advice);
    return okStatus();
}

}  // namespace glint

// JSON forms that several files share.
#pragma once

#include "gltf/import.h"
#include "plan/effects.h"
#include "plan/strategy_cost.h"

#include <glint/package_modules.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace glint::compiler {

// Returns 2^n for n bits, as a whole number if every JSON reader takes it exactly.
inline nlohmann::ordered_json countToJson(double count) {
    constexpr double kLargest = 9007199254740992.0;  // 2^53
    return count <= kLargest ? nlohmann::ordered_json(static_cast<std::uint64_t>(count))
                             : nlohmann::ordered_json(count);
}

// Says which of a file's scenes was read; null if the file has none.
inline nlohmann::ordered_json sceneInFileToJson(const gltf::SceneInFile& scene) {
    return scene.index < 0
               ? nlohmann::ordered_json(nullptr)
               : nlohmann::ordered_json{{"index", scene.index},
                                        {"name", scene.name.empty() ? nlohmann::ordered_json(nullptr)
                                                                    : nlohmann::ordered_json(scene.name)}};
}

// Rounds a share of hits to four decimals, which is more than its accuracy.
inline nlohmann::ordered_json shareToJson(double share) {
    return std::round(share * 1e4) / 1e4;
}

// Rounds an estimate to four digits. That is more than its accuracy, and gives the same text on every
// machine.
inline nlohmann::ordered_json estimateToJson(double value) {
    if (value == 0.0 || !std::isfinite(value)) {
        return 0.0;
    }
    const double scale = std::pow(10.0, 3.0 - std::floor(std::log10(std::abs(value))));
    return scale >= 1.0 ? std::round(value * scale) / scale : std::round(value);
}

// Describes which strategy was or would be chosen, and the expected time of each.
inline nlohmann::ordered_json strategyChoiceToJson(const StrategyAdvice& advice) {
    const FrameFacts& facts = advice.choice.facts;
    nlohmann::ordered_json estimates = nlohmann::ordered_json::array();
    for (const StrategyEstimate& estimate : advice.choice.estimates) {
        nlohmann::ordered_json parts = nlohmann::ordered_json::object();
        for (const CostTermInfo& info : costTerms()) {
            if (hasTerm(estimate.strategy, info.term)) {
                parts[std::string(info.name)] =
                    estimateToJson(estimate.parts[static_cast<std::size_t>(info.term)]);
            }
        }
        estimates.push_back({{"strategy", estimate.strategy},
                             {"available", estimate.available},
                             {"milliseconds", estimateToJson(estimate.ms)},
                             {"parts", parts}});
    }
    return {{"strategy", advice.choice.strategy},
            {"why", advice.choice.why},
            {"device", advice.device},
            {"builtIn", advice.builtIn},
            {"pixels", advice.pixels},
            {"bounces", facts.bounces},
            {"rays", estimateToJson(facts.rays)},
            {"laterRays", estimateToJson(facts.laterRays)},
            {"hits", estimateToJson(facts.hits)},
            {"cases", facts.cases},
            {"instructions", estimateToJson(facts.instructions)},
            {"coherence", shareToJson(facts.coherence)},
            {"casesRun", estimateToJson(facts.casesRun)},
            {"estimates", estimates}};
}

// Names one of a case's modules by its purpose.
inline std::string stageName(const package::ModuleKey& key) {
    const auto strategy = static_cast<package::Strategy>(package::findRole(key.role)->strategies);
    const bool alone = (strategy & package::pipelineStrategies()) != 0;
    const std::string name(package::nameOf(strategy));
    return alone || key.tracer != package::kTracerRayPipeline ? name : name + ", ray-pipeline";
}

// Lists every effect, chosen or not.
inline nlohmann::ordered_json effectsToJson(const EffectPlan& plan) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const EffectDecision& decision : plan.decisions) {
        list.push_back({{"name", decision.name},
                        {"chosen", decision.chosen},
                        {"usable", decision.usable},
                        {"reason", decision.reason}});
    }
    return list;
}

}  // namespace glint::compiler

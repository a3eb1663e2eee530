// What several files say alike in JSON.
#pragma once

#include "plan/effects.h"

#include <glint/package_modules.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>
#include <string_view>

namespace glint {

// 2^n for n bits, as a whole number as long as every JSON reader takes it exactly.
inline nlohmann::ordered_json countToJson(double count) {
    constexpr double kLargest = 9007199254740992.0;  // 2^53
    return count <= kLargest ? nlohmann::ordered_json(static_cast<std::uint64_t>(count))
                             : nlohmann::ordered_json(count);
}

// A share of hits to four decimals, which is more than is known of it.
inline nlohmann::ordered_json shareToJson(double share) {
    return std::round(share * 1e4) / 1e4;
}

// Which of a case's modules this is, by what it is for.
constexpr std::string_view stageName(const package::ModuleKey& key) {
    if (key.role == package::ModuleRole::HitCase) {
        return "hit-shaders";
    }
    return key.tracer == package::kTracerRayPipeline ? "visibility, ray-pipeline" : "visibility";
}

// Every effect that there is, chosen or not.
inline nlohmann::ordered_json effectsToJson(const EffectPlan& plan) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const EffectDecision& decision : plan.decisions) {
        list.push_back({{"name", package::nameOf(decision.effect)},
                        {"chosen", decision.chosen},
                        {"usable", decision.usable},
                        {"reason", decision.reason}});
    }
    return list;
}

}  // namespace glint

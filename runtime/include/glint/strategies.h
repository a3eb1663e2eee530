// The strategies: how the hits of rays are shaded. A table has one row for each; compiler, loader, renderer
// and tools act on what the row says. shaders/strategies/<strategy>/ has its shaders.
#pragma once

#include <glint/names.h>
#include <glint/package_format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

namespace glint::package {

struct StrategyInfo {
    Strategy strategy;
    std::string_view name;  // on the command line and in the manifest
    std::string_view what;
    // It stores hits and orders them by shader before it shades them. The others shade a hit where they find
    // it, so that they can read its positions from the acceleration structure.
    bool ordersHits = false;
    bool dispatchesCases = false;  // one dispatch for each case, so that no shader holds all cases
    bool fillsWorkgroups = false;  // workgroups have hits of one case, so that the switch is uniform in each
    bool ownPipeline = false;      // a ray tracing pipeline of its own, whatever traces for the others
};

// The first is what the others are measured against.
inline constexpr StrategyInfo kStrategyTable[] = {
    {.strategy = kStrategyUber,
     .name = "uber",
     .what = "one dispatch traces and shades, with a switch over the shaders"},
    {.strategy = kStrategyVisibility,
     .name = "visibility",
     .what = "hits are sorted by shader first, then there is one dispatch for each shader",
     .ordersHits = true,
     .dispatchesCases = true},
    {.strategy = kStrategySortedUber,
     .name = "sorted-uber",
     .what = "hits are sorted, then there is one dispatch, whose switch is uniform in each workgroup",
     .ordersHits = true,
     .fillsWorkgroups = true},
    {.strategy = kStrategyHitShaders,
     .name = "hit-shaders",
     .what = "a ray tracing pipeline with a closest-hit shader for each case",
     .ownPipeline = true},
};
inline constexpr std::size_t kStrategyCount = std::size(kStrategyTable);
static_assert(kAllStrategies == (1U << kStrategyCount) - 1U);

// Names on the command line and in the manifest.
inline constexpr auto kStrategyNames = [] {
    std::array<Named<Strategy>, kStrategyCount> names{};
    for (std::size_t i = 0; i < kStrategyCount; ++i) {
        names[i] = {kStrategyTable[i].strategy, kStrategyTable[i].name, kStrategyTable[i].what};
    }
    return names;
}();
inline constexpr auto kStrategies = [] {
    std::array<Strategy, kStrategyCount> strategies{};
    for (std::size_t i = 0; i < kStrategyCount; ++i) {
        strategies[i] = kStrategyTable[i].strategy;
    }
    return strategies;
}();

// Returns the strategies whose row says so, as bits.
constexpr std::uint32_t strategiesThat(bool StrategyInfo::*says) {
    std::uint32_t strategies = 0;
    for (const StrategyInfo& info : kStrategyTable) {
        strategies |= info.*says ? std::uint32_t{info.strategy} : 0U;
    }
    return strategies;
}
inline constexpr std::uint32_t kOrderedStrategies = strategiesThat(&StrategyInfo::ordersHits);
inline constexpr std::uint32_t kPipelineStrategies = strategiesThat(&StrategyInfo::ownPipeline);

// Returns null for a name that no strategy has.
constexpr const StrategyInfo* findStrategy(std::string_view name) {
    for (const StrategyInfo& info : kStrategyTable) {
        if (info.name == name) {
            return &info;
        }
    }
    return nullptr;
}

}  // namespace glint::package

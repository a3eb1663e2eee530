#include <glint/internal/package_modules.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

namespace glint::package {
namespace {

// A strategy as it is declared. Its folder has the sources.
struct Row {
    std::string_view name;
    std::string_view what;
    std::array<StrategyModule, 8> modules;
};

// A new strategy comes last: the bits of the others stand in packages.
constexpr Row kRows[] = {
    {.name = "uber",
     .what = "one dispatch traces and shades, with a switch over the shaders",
     .modules = {{{.name = "UberShade",
                   .source = "strategies/uber/uber.comp",
                   .kind = ShaderKind::Tracing,
                   .over = Over::Rays,
                   .pass = "uber",
                   .cases = CaseCode::Switch,
                   .fallback = "UberFallback"}}}},
    {.name = "visibility",
     .what = "hits are sorted by shader first, then there is one dispatch for each shader",
     .modules = {{{.name = "ShadeMiss",
                   .source = "strategies/visibility/shade_miss.comp",
                   .kind = ShaderKind::Compute,
                   .over = Over::Misses,
                   .pass = "shade miss"},
                  {.name = "ShadeCase",
                   .source = "strategies/visibility/shade_case.comp.mustache",
                   .kind = ShaderKind::Shading,
                   .over = Over::Buckets,
                   .pass = "shade",
                   .cases = CaseCode::Own,
                   .fallback = "ShadeFallback"}}}},
    {.name = "sorted-uber",
     .what = "hits are sorted, then there is one dispatch, whose switch is uniform in each workgroup",
     .modules = {{{.name = "SortedShade",
                   .source = "strategies/sorted_uber/sorted_shade.comp",
                   .kind = ShaderKind::Shading,
                   .over = Over::OrderedHits,
                   .pass = "sorted uber",
                   .cases = CaseCode::Switch,
                   .fallback = "SortedFallback"}}}},
    {.name = "hit-shaders",
     .what = "a ray tracing pipeline with a closest-hit shader for each case",
     .modules =
         {{{.name = "HitTrace",
            .source = "strategies/hit_shaders/hit_trace.rgen",
            .kind = ShaderKind::RayGeneration,
            .over = Over::Rays,
            .pass = "hit shaders"},
           {.name = "HitCase",
            .source = "strategies/hit_shaders/hit_case.rchit.mustache",
            .kind = ShaderKind::ClosestHit,
            .cases = CaseCode::Own,
            .fallback = "HitFallback"},
           // This one shades hits whose shader ID no case has.
           {.name = "HitUnknown",
            .source = "strategies/hit_shaders/hit_unknown.rchit",
            .kind = ShaderKind::ClosestHit},
           {.name = "HitMiss", .source = "strategies/hit_shaders/hit_miss.rmiss", .kind = ShaderKind::Miss},
           {.name = "HitAnyHit",
            .source = "strategies/hit_shaders/hit_any.rahit",
            .kind = ShaderKind::AnyHit}}}},
};
constexpr std::size_t kCount = std::size(kRows);
static_assert(kCount <= 32);  // bits of a set

constexpr std::span<const StrategyModule> modulesOf(const Row& row) {
    const auto* const end = std::ranges::find(row.modules, std::string_view(), &StrategyModule::name);
    return {row.modules.begin(), end};
}

constexpr bool hasPass(const Row& row, Over over) {
    return std::ranges::find(modulesOf(row), over, &StrategyModule::over) != modulesOf(row).end();
}

// The number of a row's modules of a kind that have code for those cases.
constexpr std::ptrdiff_t countOf(const Row& row, ShaderKind kind, CaseCode cases = CaseCode::None) {
    return std::ranges::count_if(modulesOf(row), [&](const StrategyModule& module) {
        return module.kind == kind && module.cases == cases;
    });
}

// Checks everything that the renderer relies on.
constexpr bool isSound(const Row& row) {
    const std::ptrdiff_t pipelines = countOf(row, ShaderKind::RayGeneration);
    const bool hitShaders = countOf(row, ShaderKind::ClosestHit, CaseCode::Own) == pipelines &&
                            countOf(row, ShaderKind::ClosestHit) == pipelines &&
                            countOf(row, ShaderKind::Miss) == pipelines &&
                            countOf(row, ShaderKind::AnyHit) == pipelines;
    return pipelines <= 1 && hitShaders &&
           std::ranges::count(modulesOf(row), Over::Buckets, &StrategyModule::over) <= 1 &&
           std::ranges::all_of(modulesOf(row), [](const StrategyModule& module) {
               const bool ofCase = module.over == Over::Buckets || module.kind == ShaderKind::ClosestHit;
               return (module.over == Over::Nothing) == module.pass.empty() &&
                      (module.cases == CaseCode::None) == module.fallback.empty() &&
                      (module.cases != CaseCode::Own || ofCase);
           });
}
static_assert(std::ranges::all_of(kRows, isSound));

constexpr auto kTable = [] {
    std::array<StrategyInfo, kCount> table{};
    for (std::size_t i = 0; i < kCount; ++i) {
        const Row& row = kRows[i];
        table[i] = {.strategy = static_cast<Strategy>(1U << i),
                    .name = row.name,
                    .what = row.what,
                    .modules = modulesOf(row),
                    .ordersHits = hasPass(row, Over::OrderedHits) || hasPass(row, Over::Misses) ||
                                  hasPass(row, Over::Buckets),
                    .dispatchesCases = hasPass(row, Over::Buckets),
                    .fillsWorkgroups = hasPass(row, Over::OrderedHits),
                    .ownPipeline = countOf(row, ShaderKind::RayGeneration) > 0};
    }
    return table;
}();
static_assert(!kTable[0].ownPipeline);

constexpr auto kNames = [] {
    std::array<Named<Strategy>, kCount> names{};
    for (std::size_t i = 0; i < kCount; ++i) {
        names[i] = {kTable[i].strategy, kTable[i].name, kTable[i].what};
    }
    return names;
}();

constexpr auto kStrategies = [] {
    std::array<Strategy, kCount> strategies{};
    std::ranges::transform(kTable, strategies.begin(), &StrategyInfo::strategy);
    return strategies;
}();

}  // namespace

std::span<const StrategyInfo> strategyTable() {
    return kTable;
}

std::span<const Strategy> strategies() {
    return kStrategies;
}

std::span<const Named<Strategy>> namesOf(Strategy /*type*/) {
    return kNames;
}

const StrategyInfo* findStrategy(std::string_view name) {
    const auto* const found = std::ranges::find(kTable, name, &StrategyInfo::name);
    return found == kTable.end() ? nullptr : found;
}

const StrategyInfo& infoOf(Strategy strategy) {
    return kTable[static_cast<std::size_t>(std::countr_zero(static_cast<std::uint32_t>(strategy)))];
}

std::uint32_t allStrategies() {
    return static_cast<std::uint32_t>((std::uint64_t{1} << kCount) - 1);
}

std::uint32_t strategiesThat(bool StrategyInfo::*says) {
    std::uint32_t set = 0;
    for (const StrategyInfo& info : kTable) {
        set |= info.*says ? std::uint32_t{info.strategy} : 0U;
    }
    return set;
}

}  // namespace glint::package

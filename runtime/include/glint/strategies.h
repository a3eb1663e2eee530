// The strategies: how the hits of rays are shaded. A strategy is one row of the table in
// runtime/src/modules/strategies.cpp and one folder with its GLSL, shaders/strategies/<strategy>/. The
// compiler, the loader, the renderer, the cost model and the tools act on the row's fields.
#pragma once

#include <glint/names.h>

#include <cstdint>
#include <span>
#include <string_view>

namespace glint::package {

// A bit of a set of strategies, by the strategy's place in the table. These are names for programs; a
// strategy works without one, as findStrategy() finds it by its name.
enum Strategy : std::uint32_t {
    kStrategyUber = 1,
    kStrategyVisibility = 2,
    kStrategySortedUber = 4,
    kStrategyHitShaders = 8,
};

inline constexpr Strategy kDefaultStrategy = kStrategyVisibility;                         // of a renderer
inline constexpr std::uint32_t kDefaultStrategies = kStrategyUber | kStrategyVisibility;  // of a package

enum class ShaderKind : std::uint8_t {
    Vertex,
    Fragment,
    Compute,
    Tracing,  // compute with ray queries, or ray generation
    Shading,  // as Tracing if it traces the shadow rays of hits, and else as Compute
    RayGeneration,
    ClosestHit,
    AnyHit,
    Miss,
};

// The cases that a module has code for.
enum class CaseCode : std::uint8_t {
    None,
    Switch,  // for all, with a switch over them
    Own,     // for one: each case has a module of its own
};

// The elements over which the pass of a module is dispatched.
enum class Over : std::uint8_t {
    Nothing,      // it has no pass: a ray tracing pipeline of its strategy runs it
    Rays,         // every ray of the list
    OrderedHits,  // every slot of the ordered hits; buckets begin at multiples of a workgroup
    Misses,       // bucket 0: rays that hit nothing, and hits whose shader ID no case has
    Buckets,      // the bucket of its case
};

// A module of a strategy, which packages with rays have. The passes of a strategy write different samples,
// so they follow each other without a barrier.
struct StrategyModule {
    std::string_view name;    // stable; the name in the manifest
    std::string_view source;  // a file below shaders/, or a template (".mustache")
    ShaderKind kind{};
    Over over = Over::Nothing;
    std::string_view pass{};  // the name of its pass, for people; the name of the case follows for Buckets
    CaseCode cases = CaseCode::None;
    // The name of the module that packages with a fallback have beside it: the same source, with code for
    // every material and for no case. Modules with code for cases have one.
    std::string_view fallback{};
};

struct StrategyInfo {
    Strategy strategy{};
    std::string_view name;  // on the command line and in the manifest
    std::string_view what;  // a sentence without a full stop
    std::span<const StrategyModule> modules{};

    // These follow from the modules. A strategy that orders hits stores them and orders them by shader before
    // it shades them. The others shade a hit where they find it, so that they can read its positions from the
    // acceleration structure.
    bool ordersHits = false;
    bool dispatchesCases = false;  // one dispatch for each case, so that no shader holds all cases
    bool fillsWorkgroups = false;  // workgroups have hits of one case, so that the switch is uniform in each
    bool ownPipeline = false;      // a ray tracing pipeline of its own, whatever traces for the others
};

// The rows in their order. The others are measured against the first, which every device can run.
std::span<const StrategyInfo> strategyTable();
std::span<const Strategy> strategies();
std::span<const Named<Strategy>> namesOf(Strategy type);

// Returns null for a name that no strategy has.
const StrategyInfo* findStrategy(std::string_view name);
// `strategy` must be the bit of a row.
const StrategyInfo& infoOf(Strategy strategy);

// Return sets of strategies as bits: all of them, and those whose row says so.
std::uint32_t allStrategies();
std::uint32_t strategiesThat(bool StrategyInfo::*says);
inline std::uint32_t orderedStrategies() {
    return strategiesThat(&StrategyInfo::ordersHits);
}
inline std::uint32_t pipelineStrategies() {
    return strategiesThat(&StrategyInfo::ownPipeline);
}

}  // namespace glint::package

// Which modules a package has: the one list that the compiler fills, the loader checks and the renderer draws
// from.
#pragma once

#include <glint/package_format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

namespace glint::package {

// What decides which modules there are.
struct PackageShape {
    std::uint32_t strategies = kStrategyUber | kStrategyVisibility;  // Strategy bits
    std::uint32_t tracers = kTracerRayQuery;                         // Tracer bits
    ShadowPlacement shadows = ShadowPlacement::Inline;
    bool alphaTested = false;
    std::uint32_t caseCount = 0;
    std::vector<std::uint32_t> retired{};  // shader IDs below caseCount that have no modules, ascending
    bool deforms = false;                  // a scene has meshes that follow skins or morph targets
};

// One module of a package; fields as in ModuleEntry.
struct ModuleKey {
    ModuleRole role{};
    std::uint32_t index = 0;
    std::uint32_t tracer = 0;

    friend bool operator==(const ModuleKey&, const ModuleKey&) = default;
    // NOLINTNEXTLINE(modernize-use-nullptr): a comparison against 0 that the compiler writes.
    friend auto operator<=>(const ModuleKey&, const ModuleKey&) = default;
};

enum class ShaderKind : std::uint8_t {
    Vertex,
    Fragment,
    Compute,
    Tracing,  // compute with ray queries, or ray generation
    RayGeneration,
    ClosestHit,
    AnyHit,
    Miss,
};

enum class Repeated : std::uint8_t { Once, ByCase, ByOrdering };

struct RoleInfo {
    ModuleRole role;
    std::uint32_t strategies;  // Strategy bits
    std::string_view name;     // stable, as in the manifest
    ShaderKind kind;
    Repeated repeated = Repeated::Once;
    bool shades = false;  // hits: traces only where shadows are inline
};

// Names as on the command line and in the manifest; "unknown" for what is not one value.
constexpr std::string_view nameOf(Strategy strategy) {
    switch (strategy) {
        case kStrategyUber:
            return "uber";
        case kStrategyVisibility:
            return "visibility";
        case kStrategySortedUber:
            return "sorted-uber";
        case kStrategyHitShaders:
            return "hit-shaders";
        default:
            return "unknown";
    }
}

constexpr std::string_view nameOf(Tracer tracer) {
    switch (tracer) {
        case kTracerRayQuery:
            return "ray-query";
        case kTracerRayPipeline:
            return "ray-pipeline";
        default:
            return "unknown";
    }
}

constexpr std::string_view nameOf(ShadowPlacement shadows) {
    return shadows == ShadowPlacement::Deferred ? "deferred" : "inline";
}

constexpr std::string_view nameOf(HitRecordFormat format) {
    return format == HitRecordFormat::Packed ? "packed" : "full";
}

constexpr std::string_view nameOf(Ordering ordering) {
    constexpr std::string_view kNames[] = {"global-atomics", "wave-loop",       "wave-aggregated",
                                           "wave-ballot",    "local-histogram", "unknown"};
    return kNames[ordering < Ordering::Count ? static_cast<std::uint32_t>(ordering) : 5];
}

inline constexpr Strategy kStrategies[] = {kStrategyUber, kStrategyVisibility, kStrategySortedUber,
                                           kStrategyHitShaders};
inline constexpr Tracer kTracers[] = {kTracerRayQuery, kTracerRayPipeline};

inline constexpr std::uint32_t kOrderedStrategies = kStrategyVisibility | kStrategySortedUber;

// By role.
inline constexpr RoleInfo kRoles[] = {
    {ModuleRole::GBufferVertex, kAllStrategies, "GBufferVertex", ShaderKind::Vertex},
    {ModuleRole::GBufferFragment, kAllStrategies, "GBufferFragment", ShaderKind::Fragment},
    {ModuleRole::Lighting, kAllStrategies, "Lighting", ShaderKind::Tracing},
    {ModuleRole::ReflectionRays, kAllStrategies, "ReflectionRays", ShaderKind::Compute},
    {ModuleRole::RayDispatch, kAllStrategies, "RayDispatch", ShaderKind::Compute},
    {ModuleRole::UberShade, kStrategyUber, "UberShade", ShaderKind::Tracing},
    {ModuleRole::Trace, kOrderedStrategies, "Trace", ShaderKind::Tracing},
    {ModuleRole::BucketCount, kOrderedStrategies, "BucketCount", ShaderKind::Compute, Repeated::ByOrdering},
    {ModuleRole::BucketOffset, kOrderedStrategies, "BucketOffset", ShaderKind::Compute},
    {ModuleRole::BucketCopy, kOrderedStrategies, "BucketCopy", ShaderKind::Compute, Repeated::ByOrdering},
    {ModuleRole::ShadeMiss, kStrategyVisibility, "ShadeMiss", ShaderKind::Compute},
    {ModuleRole::ShadeCase, kStrategyVisibility, "ShadeCase", ShaderKind::Tracing, Repeated::ByCase, true},
    {ModuleRole::Compose, kAllStrategies, "Compose", ShaderKind::Compute},
    {ModuleRole::SortedShade, kStrategySortedUber, "SortedShade", ShaderKind::Tracing, Repeated::Once, true},
    {ModuleRole::ShadowDispatch, kAllStrategies, "ShadowDispatch", ShaderKind::Compute},
    {ModuleRole::ShadowTrace, kAllStrategies, "ShadowTrace", ShaderKind::Tracing},
    {ModuleRole::OrderCheck, kOrderedStrategies, "OrderCheck", ShaderKind::Compute},
    {ModuleRole::TraceClosestHit, kAllStrategies, "TraceClosestHit", ShaderKind::ClosestHit},
    {ModuleRole::TraceAnyHit, kAllStrategies, "TraceAnyHit", ShaderKind::AnyHit},
    {ModuleRole::TraceMiss, kAllStrategies, "TraceMiss", ShaderKind::Miss},
    {ModuleRole::HitTrace, kStrategyHitShaders, "HitTrace", ShaderKind::RayGeneration},
    {ModuleRole::HitCase, kStrategyHitShaders, "HitCase", ShaderKind::ClosestHit, Repeated::ByCase},
    {ModuleRole::HitUnknown, kStrategyHitShaders, "HitUnknown", ShaderKind::ClosestHit},
    {ModuleRole::HitMiss, kStrategyHitShaders, "HitMiss", ShaderKind::Miss},
    {ModuleRole::Deform, kAllStrategies, "Deform", ShaderKind::Compute},
};

// Null for a number that is no role.
constexpr const RoleInfo* findRole(ModuleRole role) {
    for (const RoleInfo& info : kRoles) {
        if (info.role == role) {
            return &info;
        }
    }
    return nullptr;
}

constexpr std::string_view roleName(ModuleRole role) {
    const RoleInfo* const info = findRole(role);
    return info == nullptr ? std::string_view("unknown") : info->name;
}

// Tracer bits that strategies come with: hit-shaders has a pipeline, the others what the package has.
constexpr std::uint32_t tracersOf(std::uint32_t strategies, std::uint32_t tracers) {
    const bool others = (strategies & ~kStrategyHitShaders) != 0;
    const bool hitShaders = (strategies & kStrategyHitShaders) != 0;
    return (others ? tracers : 0U) | (hitShaders ? std::uint32_t{kTracerRayPipeline} : 0U);
}

// Tracer values of the modules of a role: several, one, or {0} where it traces nothing. Empty: it is not
// needed.
inline std::vector<std::uint32_t> moduleTracers(const RoleInfo& info, const PackageShape& shape) {
    const std::uint32_t strategies = info.strategies & shape.strategies;
    const bool deferred = shape.shadows == ShadowPlacement::Deferred;
    const bool ofShadows = info.role == ModuleRole::ShadowDispatch || info.role == ModuleRole::ShadowTrace;
    const bool untested = info.kind == ShaderKind::AnyHit && !shape.alphaTested;
    const bool still = info.role == ModuleRole::Deform && !shape.deforms;
    if (strategies == 0 || (ofShadows && !deferred) || untested || still) {
        return {};
    }
    const std::uint32_t tracers = tracersOf(strategies, shape.tracers);
    const bool pipeline = (tracers & kTracerRayPipeline) != 0;
    switch (info.kind) {
        case ShaderKind::Vertex:
        case ShaderKind::Fragment:
        case ShaderKind::Compute:
            return {0};
        case ShaderKind::Tracing:
            if (info.shades && deferred) {
                return {0};
            }
            break;
        default:
            return pipeline ? std::vector<std::uint32_t>{kTracerRayPipeline} : std::vector<std::uint32_t>{};
    }
    std::vector<std::uint32_t> result;
    for (const Tracer tracer : kTracers) {
        if ((tracers & tracer) != 0) {
            result.push_back(tracer);
        }
    }
    return result;
}

// Every module of a package, in order of role, index, tracer.
inline std::vector<ModuleKey> requiredModules(const PackageShape& shape) {
    std::vector<ModuleKey> keys;
    for (const RoleInfo& info : kRoles) {
        const std::uint32_t count = info.repeated == Repeated::ByCase ? shape.caseCount
                                    : info.repeated == Repeated::ByOrdering
                                        ? static_cast<std::uint32_t>(Ordering::Count)
                                        : 1U;
        const std::vector<std::uint32_t> tracers = moduleTracers(info, shape);
        for (std::uint32_t index = 0; index < count; ++index) {
            if (info.repeated == Repeated::ByCase && std::ranges::binary_search(shape.retired, index)) {
                continue;
            }
            for (const std::uint32_t tracer : tracers) {
                keys.push_back({info.role, index, tracer});
            }
        }
    }
    return keys;
}

}  // namespace glint::package

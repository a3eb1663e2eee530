// The list of the modules that a package has. The compiler fills it, the loader checks it and the renderer
// draws from it.
#pragma once

#include <glint/names.h>
#include <glint/package_format.h>
#include <glint/strategies.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <span>
#include <string_view>
#include <vector>

namespace glint::package {

// The properties of a package that decide which modules it has.
struct PackageShape {
    std::uint32_t strategies = kStrategyUber | kStrategyVisibility;  // Strategy bits
    std::uint32_t tracers = kTracerRayQuery;                         // Tracer bits
    ShadowPlacement shadows = ShadowPlacement::Inline;
    EffectSet effects{};
    bool alphaTested = false;
    std::uint32_t caseCount = 0;
    std::vector<std::uint32_t> retired{};  // ascending shader IDs below caseCount that have no modules
    bool deforms = false;                  // a scene has meshes that follow skins or morph targets
    Passes passes = Passes::Frame;
    std::uint32_t maxBounces = 1;
    bool fallback = false;      // it has shaders for every material beside those of its cases
    bool shadowsApart = false;  // candidates of shadow rays are not treated as those of other rays
};

// One module of a package. The fields are those of ModuleEntry.
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

enum class Repeated : std::uint8_t { Once, ByCase, ByOrdering, ByEffect, ByWalk };

// Which packages have a role.
enum class Purpose : std::uint8_t {
    Picture,   // packages that draw a frame
    Hits,      // packages that shade hits: for a host, or with an effect that sends rays
    Shadows,   // those among them that defer shadow rays
    Walks,     // packages with effects that follow their rays in a pass of their own
    Tracing,   // packages in which a ray tracing pipeline traces
    Paths,     // packages whose paths have several bounces
    Motion,    // packages with meshes that follow skins or morph targets
    Fallback,  // packages that shade hits, with shaders for every material
};

struct RoleInfo {
    ModuleRole role;
    std::uint32_t strategies;  // Strategy bits
    std::string_view name;     // stable; the name in the manifest
    ShaderKind kind;
    Purpose purpose = Purpose::Hits;
    Repeated repeated = Repeated::Once;
    bool shades = false;  // shades hits: it traces only if shadow rays are inline
};

// Names on the command line and in the manifest.
inline constexpr Named<Tracer> kTracerNames[] = {
    {kTracerRayQuery, "ray-query", "compute shaders trace"},
    {kTracerRayPipeline, "ray-pipeline", "ray generation shaders trace, for devices without ray queries"},
};
inline constexpr Named<ShadowPlacement> kShadowNames[] = {
    {ShadowPlacement::Inline, "inline", "by the shader that shades the hit"},
    {ShadowPlacement::Deferred, "deferred", "from a list, by a pass of their own"},
};
inline constexpr Named<AlphaPolicy> kAlphaNames[] = {
    {AlphaPolicy::Opaque, "opaque", "ignored"},
    {AlphaPolicy::Tested, "tested", "each candidate hit is tested; BLEND is opaque"},
    {AlphaPolicy::Stochastic, "stochastic", "tested, and a ray stops at BLEND with the probability alpha"},
};
inline constexpr Named<ShadowThrough> kShadowThroughNames[] = {
    {ShadowThrough::Opaque, "opaque", "glass and BLEND block"},
    {ShadowThrough::Alpha, "alpha", "as --alpha says; glass blocks"},
    {ShadowThrough::Glass, "glass", "coloured light passes glass and BLEND"},
};
inline constexpr Named<HitRecordFormat> kHitRecordNames[] = {
    {HitRecordFormat::Full, "full", "32 bytes"},
    {HitRecordFormat::Packed, "packed", "16 bytes, with less precision"},
};
inline constexpr Named<ShadingPrecision> kPrecisionNames[] = {
    {ShadingPrecision::Single, "32", "everything in 32-bit float"},
    {ShadingPrecision::Half, "16",
     "parameters of materials, Fresnel and weights of lobes in 16-bit float; geometry, densities and light "
     "keep 32"},
};
inline constexpr Named<Ordering> kOrderingNames[] = {
    {Ordering::GlobalAtomics, "global-atomics", "one atomic for each hit"},
    {Ordering::WaveLoop, "wave-loop",
     "an atomic for each shader in a subgroup, which are found one after the other"},
    {Ordering::WaveAggregated, "wave-aggregated", "a loop over all shaders, for few shaders only"},
    {Ordering::WaveBallot, "wave-ballot", "an atomic for each shader in a subgroup, found by ballots"},
    {Ordering::LocalHistogram, "local-histogram", "counts in shared memory, an atomic for each shader"},
    {Ordering::TileSort, "tile-sort", "sorts thousands of hits in shared memory"},
};
static_assert(std::size(kOrderingNames) == static_cast<std::size_t>(Ordering::Count));

inline constexpr Named<Passes> kPassesNames[] = {
    {Passes::Frame, "frame", "a whole frame, for Renderer"},
    {Passes::Steps, "steps", "what traces, orders and shades the rays of an engine's own, for RaySteps"},
};
inline constexpr Named<HitAnswer> kAnswerNames[] = {
    {HitAnswer::Radiance, "radiance", "the light that comes back along it"},
    {HitAnswer::Surface, "surface", "the surface that it hits, which the engine lights"},
};

constexpr std::span<const Named<Strategy>> namesOf(Strategy /*type*/) {
    return kStrategyNames;
}
constexpr std::span<const Named<Tracer>> namesOf(Tracer /*type*/) {
    return kTracerNames;
}
constexpr std::span<const Named<ShadowPlacement>> namesOf(ShadowPlacement /*type*/) {
    return kShadowNames;
}
constexpr std::span<const Named<AlphaPolicy>> namesOf(AlphaPolicy /*type*/) {
    return kAlphaNames;
}
constexpr std::span<const Named<ShadowThrough>> namesOf(ShadowThrough /*type*/) {
    return kShadowThroughNames;
}
constexpr std::span<const Named<HitRecordFormat>> namesOf(HitRecordFormat /*type*/) {
    return kHitRecordNames;
}
constexpr std::span<const Named<ShadingPrecision>> namesOf(ShadingPrecision /*type*/) {
    return kPrecisionNames;
}
constexpr std::span<const Named<Ordering>> namesOf(Ordering /*type*/) {
    return kOrderingNames;
}
constexpr std::span<const Named<Passes>> namesOf(Passes /*type*/) {
    return kPassesNames;
}
constexpr std::span<const Named<HitAnswer>> namesOf(HitAnswer /*type*/) {
    return kAnswerNames;
}
using glint::nameOf;

// The members of Bindings by name.
struct NamedBinding {
    std::string_view name;
    std::uint32_t Bindings::*member;
};
inline constexpr NamedBinding kBindingNames[] = {
    {"scene-set", &Bindings::sceneSet},
    {"tlas", &Bindings::tlas},
    {"textures", &Bindings::textures},
    {"samplers", &Bindings::samplers},
    {"environment-set", &Bindings::environmentSet},
    {"environment", &Bindings::environment},
    {"push-offset", &Bindings::pushOffset},
};

constexpr std::uint32_t bitsOf(ShadingPrecision precision) {
    return precision == ShadingPrecision::Single ? 32 : 16;
}

inline constexpr auto kTracers = valuesOf(kTracerNames);

// Every role, in the order of the list of modules.
inline constexpr RoleInfo kRoles[] = {
    {ModuleRole::GBufferVertex, kAllStrategies, "GBufferVertex", ShaderKind::Vertex, Purpose::Picture},
    {ModuleRole::GBufferFragment, kAllStrategies, "GBufferFragment", ShaderKind::Fragment, Purpose::Picture},
    {ModuleRole::Lighting, kAllStrategies, "Lighting", ShaderKind::Tracing, Purpose::Picture},
    {ModuleRole::EffectRays, kAllStrategies, "EffectRays", ShaderKind::Compute, Purpose::Hits,
     Repeated::ByEffect},
    {ModuleRole::RayDispatch, kAllStrategies, "RayDispatch", ShaderKind::Compute},
    {ModuleRole::UberShade, kStrategyUber, "UberShade", ShaderKind::Tracing},
    {ModuleRole::Trace, kOrderedStrategies, "Trace", ShaderKind::Tracing},
    {ModuleRole::BucketCount, kOrderedStrategies, "BucketCount", ShaderKind::Compute, Purpose::Hits,
     Repeated::ByOrdering},
    {ModuleRole::BucketOffset, kOrderedStrategies, "BucketOffset", ShaderKind::Compute},
    {ModuleRole::BucketCopy, kOrderedStrategies, "BucketCopy", ShaderKind::Compute, Purpose::Hits,
     Repeated::ByOrdering},
    {ModuleRole::ShadeMiss, kStrategyVisibility, "ShadeMiss", ShaderKind::Compute},
    {ModuleRole::ShadeCase, kStrategyVisibility, "ShadeCase", ShaderKind::Tracing, Purpose::Hits,
     Repeated::ByCase, true},
    {ModuleRole::Compose, kAllStrategies, "Compose", ShaderKind::Compute, Purpose::Picture},
    {ModuleRole::SortedShade, kStrategySortedUber, "SortedShade", ShaderKind::Tracing, Purpose::Hits,
     Repeated::Once, true},
    {ModuleRole::ShadowDispatch, kAllStrategies, "ShadowDispatch", ShaderKind::Compute, Purpose::Shadows},
    {ModuleRole::ShadowTrace, kAllStrategies, "ShadowTrace", ShaderKind::Tracing, Purpose::Shadows},
    {ModuleRole::OrderCheck, kOrderedStrategies, "OrderCheck", ShaderKind::Compute},
    {ModuleRole::TraceClosestHit, kAllStrategies, "TraceClosestHit", ShaderKind::ClosestHit,
     Purpose::Tracing},
    {ModuleRole::TraceAnyHit, kAllStrategies, "TraceAnyHit", ShaderKind::AnyHit, Purpose::Tracing},
    {ModuleRole::TraceMiss, kAllStrategies, "TraceMiss", ShaderKind::Miss, Purpose::Tracing},
    {ModuleRole::HitTrace, kStrategyHitShaders, "HitTrace", ShaderKind::RayGeneration},
    {ModuleRole::HitCase, kStrategyHitShaders, "HitCase", ShaderKind::ClosestHit, Purpose::Hits,
     Repeated::ByCase},
    {ModuleRole::HitUnknown, kStrategyHitShaders, "HitUnknown", ShaderKind::ClosestHit},
    {ModuleRole::HitMiss, kStrategyHitShaders, "HitMiss", ShaderKind::Miss},
    {ModuleRole::EffectWalk, kAllStrategies, "EffectWalk", ShaderKind::Tracing, Purpose::Walks,
     Repeated::ByWalk},
    {ModuleRole::PathRays, kAllStrategies, "PathRays", ShaderKind::Compute, Purpose::Paths},
    {ModuleRole::Deform, kAllStrategies, "Deform", ShaderKind::Compute, Purpose::Motion},
    {ModuleRole::UberFallback, kStrategyUber, "UberFallback", ShaderKind::Tracing, Purpose::Fallback},
    {ModuleRole::ShadeFallback, kStrategyVisibility, "ShadeFallback", ShaderKind::Tracing, Purpose::Fallback,
     Repeated::Once, true},
    {ModuleRole::SortedFallback, kStrategySortedUber, "SortedFallback", ShaderKind::Tracing,
     Purpose::Fallback, Repeated::Once, true},
    {ModuleRole::HitFallback, kStrategyHitShaders, "HitFallback", ShaderKind::ClosestHit, Purpose::Fallback},
    {ModuleRole::HitAnyHit, kStrategyHitShaders, "HitAnyHit", ShaderKind::AnyHit},
};

// Returns null for a number that is no role.
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

// Returns the Tracer bits that strategies use. Those with a pipeline of their own use the ray tracing
// pipeline; the others use the package's tracers.
constexpr std::uint32_t tracersOf(std::uint32_t strategies, std::uint32_t tracers) {
    const bool others = (strategies & ~kPipelineStrategies) != 0;
    const bool pipelines = (strategies & kPipelineStrategies) != 0;
    return (others ? tracers : 0U) | (pipelines ? std::uint32_t{kTracerRayPipeline} : 0U);
}

// Whether hits send rays further.
constexpr bool hasPaths(const PackageShape& shape) {
    return shape.passes == Passes::Frame && shape.effects.rays != 0 && shape.maxBounces > 1;
}

// Whether a package of this shape needs modules with this purpose.
constexpr bool hasPurpose(Purpose purpose, const PackageShape& shape) {
    const bool frame = shape.passes == Passes::Frame;
    const bool hits = !frame || shape.effects.rays != 0;
    switch (purpose) {
        case Purpose::Picture:
            return frame;
        case Purpose::Hits:
            return hits;
        case Purpose::Shadows:
            return hits && shape.effects.lights != 0 && shape.shadows == ShadowPlacement::Deferred;
        case Purpose::Walks:
            return frame && shape.effects.walks != 0;
        case Purpose::Paths:
            return hasPaths(shape);
        case Purpose::Tracing:
            return hits || shape.effects.tracesAtSurfaces();
        case Purpose::Motion:
            return frame && shape.deforms;
        case Purpose::Fallback:
            return hits && shape.fallback;
    }
    return false;
}

// Whether a module traces, given that modules of its kind may do so.
constexpr bool traces(const RoleInfo& info, const PackageShape& shape) {
    if (info.role == ModuleRole::Lighting) {
        return shape.effects.tracesAtSurfaces();
    }
    return !info.shades || (shape.effects.lights != 0 && shape.shadows == ShadowPlacement::Inline);
}

// Returns the Tracer values that the modules of a role have: several, one, or {0} if the role traces no rays.
// The result is empty if the package does not need the role.
inline std::vector<std::uint32_t> moduleTracers(const RoleInfo& info, const PackageShape& shape) {
    const std::uint32_t strategies = info.strategies & shape.strategies;
    const bool untested = info.kind == ShaderKind::AnyHit && !shape.alphaTested && !shape.shadowsApart;
    const bool shared = info.role == ModuleRole::HitAnyHit && !shape.shadowsApart;
    if (strategies == 0 || !hasPurpose(info.purpose, shape) || untested || shared) {
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
            if (!traces(info, shape)) {
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

// Returns the indices that the modules of a role have, ascending.
inline std::vector<std::uint32_t> moduleIndices(const RoleInfo& info, const PackageShape& shape) {
    std::vector<std::uint32_t> indices;
    switch (info.repeated) {
        case Repeated::Once:
            indices.push_back(0);
            break;
        case Repeated::ByCase:
            for (std::uint32_t index = 0; index < shape.caseCount; ++index) {
                if (!std::ranges::binary_search(shape.retired, index)) {
                    indices.push_back(index);
                }
            }
            break;
        case Repeated::ByOrdering:
            for (std::uint32_t index = 0; index < static_cast<std::uint32_t>(Ordering::Count); ++index) {
                indices.push_back(index);
            }
            break;
        case Repeated::ByEffect:
            forEachEffect(shape.effects.rays, [&](std::uint32_t number) { indices.push_back(number); });
            break;
        case Repeated::ByWalk:
            forEachEffect(shape.effects.walks, [&](std::uint32_t number) { indices.push_back(number); });
            break;
    }
    return indices;
}

// Returns every module of a package, in the order of role, index, tracer.
inline std::vector<ModuleKey> requiredModules(const PackageShape& shape) {
    std::vector<ModuleKey> keys;
    for (const RoleInfo& info : kRoles) {
        const std::vector<std::uint32_t> tracers = moduleTracers(info, shape);
        if (tracers.empty()) {
            continue;
        }
        for (const std::uint32_t index : moduleIndices(info, shape)) {
            for (const std::uint32_t tracer : tracers) {
                keys.push_back({info.role, index, tracer});
            }
        }
    }
    return keys;
}

}  // namespace glint::package

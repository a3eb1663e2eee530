#include <glint/internal/package_modules.h>

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace glint::package {
namespace {

// The feature that a capability of SPIR-V needs (Vulkan specification, "Capabilities"). Every device with
// Vulkan 1.3 has the features that have no name here.
struct CapabilityFeature {
    std::uint32_t capability;
    const char* feature;
};
constexpr CapabilityFeature kCapabilities[] = {
    {0, ""},  // Matrix
    {1, ""},  // Shader
    {9, "shaderFloat16"},
    {10, "shaderFloat64"},
    {11, "shaderInt64"},
    {22, "shaderInt16"},
    {25, "shaderImageGatherExtended"},
    {29, "shaderSampledImageArrayDynamicIndexing"},
    {31, "shaderStorageImageArrayDynamicIndexing"},
    {39, "shaderInt8"},
    {49, "shaderStorageImageExtendedFormats"},
    {50, ""},  // ImageQuery
    {55, "shaderStorageImageReadWithoutFormat"},
    {56, "shaderStorageImageWriteWithoutFormat"},
    {61, ""},  // GroupNonUniform: the basic operations
    {62, "VK_SUBGROUP_FEATURE_VOTE_BIT"},
    {63, "VK_SUBGROUP_FEATURE_ARITHMETIC_BIT"},
    {64, "VK_SUBGROUP_FEATURE_BALLOT_BIT"},
    {65, "VK_SUBGROUP_FEATURE_SHUFFLE_BIT"},
    {66, "VK_SUBGROUP_FEATURE_SHUFFLE_RELATIVE_BIT"},
    {67, "VK_SUBGROUP_FEATURE_CLUSTERED_BIT"},
    {68, "VK_SUBGROUP_FEATURE_QUAD_BIT"},
    {4433, "storageBuffer16BitAccess"},
    {4434, "uniformAndStorageBuffer16BitAccess"},
    {4448, "storageBuffer8BitAccess"},
    {4472, "rayQuery"},
    {4478, ""},  // RayTraversalPrimitiveCullingKHR: part of rayQuery and of rayTraversalPrimitiveCulling
    {4479, "rayTracingPipeline"},
    {5055, "shaderSubgroupClock"},
    {5301, ""},  // ShaderNonUniform: comes with a capability that says which resources
    {5302, "runtimeDescriptorArray"},
    {5307, "shaderSampledImageArrayNonUniformIndexing"},
    {5336, "rayTracingPositionFetch"},
    {5391, "rayTracingPositionFetch"},
    {5345, "vulkanMemoryModel"},
    {5347, "bufferDeviceAddress"},
};

// The numbers of a strategy's roles begin at a multiple of this.
constexpr std::uint32_t kRolesOfStrategy = 64;

// The roles that strategies share.
std::vector<RoleInfo> sharedRoles() {
    const std::uint32_t all = allStrategies();
    const std::uint32_t ordered = orderedStrategies();
    return {
        {ModuleRole::GBufferVertex, all, "GBufferVertex", "passes/gbuffer.vert", ShaderKind::Vertex,
         Purpose::Picture},
        {ModuleRole::GBufferFragment, all, "GBufferFragment", "passes/gbuffer.frag", ShaderKind::Fragment,
         Purpose::Picture},
        {.role = ModuleRole::FirstHit,
         .strategies = all,
         .name = "FirstHit",
         .source = "first/first_hit.comp.mustache",
         .kind = ShaderKind::Tracing,
         .purpose = Purpose::Picture,
         .repeated = Repeated::ByCase,
         .over = Over::Buckets,
         .pass = "first",
         .fallback = ModuleRole::FirstFallback},
        {ModuleRole::EffectRays, all, "EffectRays", "effect_rays.comp.mustache", ShaderKind::Compute,
         Purpose::Hits, Repeated::ByEffect},
        {ModuleRole::RayDispatch, all, "RayDispatch", "passes/ray_dispatch.comp", ShaderKind::Compute},
        {ModuleRole::Trace, ordered, "Trace", "passes/trace.comp", ShaderKind::Tracing},
        {ModuleRole::BucketCount, ordered, "BucketCount", "passes/bucket_count.comp", ShaderKind::Compute,
         Purpose::Hits, Repeated::ByOrdering},
        {ModuleRole::BucketOffset, all, "BucketOffset", "passes/bucket_offset.comp", ShaderKind::Compute,
         Purpose::Order},
        {ModuleRole::BucketCopy, ordered, "BucketCopy", "passes/bucket_copy.comp", ShaderKind::Compute,
         Purpose::Hits, Repeated::ByOrdering},
        {ModuleRole::OrderCheck, ordered, "OrderCheck", "passes/order_check.comp", ShaderKind::Compute},
        {ModuleRole::Compose, all, "Compose", "passes/compose.comp", ShaderKind::Compute, Purpose::Picture},
        {ModuleRole::ShadowDispatch, all, "ShadowDispatch", "passes/shadow_dispatch.comp",
         ShaderKind::Compute, Purpose::Shadows},
        {ModuleRole::ShadowTrace, all, "ShadowTrace", "passes/shadow_trace.comp", ShaderKind::Tracing,
         Purpose::Shadows},
        {ModuleRole::TraceClosestHit, all, "TraceClosestHit", "passes/trace.rchit", ShaderKind::ClosestHit,
         Purpose::Tracing},
        {ModuleRole::TraceAnyHit, all, "TraceAnyHit", "passes/trace.rahit", ShaderKind::AnyHit,
         Purpose::Tracing},
        {ModuleRole::TraceMiss, all, "TraceMiss", "passes/trace.rmiss", ShaderKind::Miss, Purpose::Tracing},
        // Its source is the effect's.
        {ModuleRole::EffectWalk, all, "EffectWalk", "", ShaderKind::Tracing, Purpose::Walks,
         Repeated::ByWalk},
        {ModuleRole::PathRays, all, "PathRays", "passes/path_rays.comp", ShaderKind::Compute, Purpose::Paths},
        {ModuleRole::Deform, all, "Deform", "passes/deform.comp", ShaderKind::Compute, Purpose::Motion},
        {ModuleRole::FirstDraft, all, "FirstDraft", "first/first_draft.comp.mustache", ShaderKind::Compute,
         Purpose::Draft},
        {ModuleRole::FirstCount, all, "FirstCount", "first/first_count.comp", ShaderKind::Compute,
         Purpose::Picture},
        {ModuleRole::FirstCopy, all, "FirstCopy", "first/first_copy.comp", ShaderKind::Compute,
         Purpose::Picture},
        {.role = ModuleRole::FirstMiss,
         .strategies = all,
         .name = "FirstMiss",
         .source = "first/first_miss.comp",
         .kind = ShaderKind::Compute,
         .purpose = Purpose::Picture,
         .over = Over::Misses,
         .pass = "first miss"},
        {.role = ModuleRole::FirstFallback,
         .strategies = all,
         .name = "FirstFallback",
         .source = "first/first_hit.comp.mustache",
         .kind = ShaderKind::Tracing,
         .purpose = Purpose::Fallback,
         .over = Over::Misses,
         .pass = "first"},
        {ModuleRole::FirstShadows, all, "FirstShadows", "first/first_shadows.comp", ShaderKind::Tracing,
         Purpose::FirstShadows},
        {ModuleRole::RayVisibility, all, "RayVisibility", "passes/ray_visibility.comp", ShaderKind::Tracing,
         Purpose::Visibility},
    };
}

// Adds the roles of a strategy's modules and of their fallbacks.
void addRoles(std::vector<RoleInfo>& roles, const StrategyInfo& strategy, std::uint32_t first) {
    for (const StrategyModule& module : strategy.modules) {
        RoleInfo info{.role = static_cast<ModuleRole>(first++),
                      .strategies = strategy.strategy,
                      .name = module.name,
                      .source = module.source,
                      .kind = module.kind,
                      .repeated = module.cases == CaseCode::Own ? Repeated::ByCase : Repeated::Once,
                      .declared = &module,
                      .over = module.over,
                      .pass = module.pass};
        const auto fallback = static_cast<ModuleRole>(first++);
        if (module.fallback.empty()) {
            roles.push_back(info);
            continue;
        }
        info.fallback = fallback;
        roles.push_back(info);
        info.role = fallback;
        info.name = module.fallback;
        info.purpose = Purpose::Fallback;
        info.repeated = Repeated::Once;
        info.over = module.over == Over::Buckets ? Over::Misses : Over::Nothing;
        info.fallback = ModuleRole::None;
        roles.push_back(info);
    }
}

// Returns whether a package of this shape needs modules of a role, by its purpose.
bool isNeeded(const RoleInfo& info, const PackageShape& shape) {
    const bool frame = shape.passes == Passes::Frame;
    const bool hits = !frame || shape.effects.rays != 0;
    switch (info.purpose) {
        case Purpose::Picture:
            return frame;
        case Purpose::Order:
            return frame || (shape.strategies & orderedStrategies()) != 0;
        case Purpose::Hits:
            return hits;
        case Purpose::Shadows:
            return hits && shape.effects.lights != 0 && shape.shadows == ShadowPlacement::Deferred;
        case Purpose::FirstShadows:
            return shape.defersFirstShadows();
        case Purpose::Visibility:
            return !frame;
        case Purpose::Walks:
            return frame && shape.effects.walks != 0;
        case Purpose::Paths:
            return hasPaths(shape);
        case Purpose::Tracing:
            return hits || shape.effects.tracesAtSurfaces();
        case Purpose::Motion:
            return frame && shape.deforms;
        case Purpose::Fallback:
            return shape.fallback && (info.shadesFirst() ? frame : hits);
        case Purpose::Draft:
            return frame && shape.fallback;
    }
    return false;
}

// Returns whether a module traces, given that modules of its kind may trace.
bool traces(const RoleInfo& info, const PackageShape& shape) {
    if (info.shadesFirst()) {
        return shape.effects.tracesAtSurfaces() && !shape.defersFirstShadows();
    }
    return info.kind == ShaderKind::Tracing ||
           (shape.effects.lights != 0 && shape.shadows == ShadowPlacement::Inline);
}

// Any-hit shaders test alpha. A strategy has one of its own where its pipeline's shadow rays read more.
bool isLeftOut(const RoleInfo& info, const PackageShape& shape) {
    return info.kind == ShaderKind::AnyHit && !shape.shadowsApart &&
           (info.declared != nullptr || !shape.alphaTested);
}

// Returns the Tracer values that the modules of a role have: several, one, or {0} if the role traces no rays.
// The result is empty if the package does not need the role.
std::vector<std::uint32_t> moduleTracers(const RoleInfo& info, const PackageShape& shape) {
    const std::uint32_t strategies = info.strategies & shape.strategies;
    if (strategies == 0 || !isNeeded(info, shape) || isLeftOut(info, shape)) {
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
        case ShaderKind::Shading:
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
std::vector<std::uint32_t> moduleIndices(const RoleInfo& info, const PackageShape& shape) {
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

}  // namespace

std::span<const RoleInfo> roles() {
    static const std::vector<RoleInfo> kRoles = [] {
        std::vector<RoleInfo> roles = sharedRoles();
        std::uint32_t first = kRolesOfStrategy;
        for (const StrategyInfo& strategy : strategyTable()) {
            addRoles(roles, strategy, first);
            first += kRolesOfStrategy;
        }
        return roles;
    }();
    return kRoles;
}

std::span<const RoleInfo> rolesOf(Strategy strategy) {
    const auto isOwn = [&](const RoleInfo& info) {
        return info.declared != nullptr && info.strategies == strategy;
    };
    const std::span<const RoleInfo> all = roles();
    const auto first = std::ranges::find_if(all, isOwn);
    return {first, std::find_if_not(first, all.end(), isOwn)};
}

std::span<const RoleInfo> firstRoles() {
    static const std::vector<RoleInfo> kRoles{*findRole(ModuleRole::FirstMiss),
                                              *findRole(ModuleRole::FirstHit),
                                              *findRole(ModuleRole::FirstFallback)};
    return kRoles;
}

const RoleInfo* findRole(ModuleRole role) {
    const auto found = std::ranges::lower_bound(roles(), role, {}, &RoleInfo::role);
    return found == roles().end() || found->role != role ? nullptr : &*found;
}

std::string_view roleName(ModuleRole role) {
    const RoleInfo* const info = findRole(role);
    return info == nullptr ? std::string_view("unknown") : info->name;
}

ModuleRole roleNamed(std::string_view name) {
    const auto found = std::ranges::find(roles(), name, &RoleInfo::name);
    return found == roles().end() ? ModuleRole::None : found->role;
}

std::uint32_t tracersOf(std::uint32_t strategies, std::uint32_t tracers) {
    const bool others = (strategies & ~pipelineStrategies()) != 0;
    const bool pipelines = (strategies & pipelineStrategies()) != 0;
    return (others ? tracers : 0U) | (pipelines ? std::uint32_t{kTracerRayPipeline} : 0U);
}

bool hasPaths(const PackageShape& shape) {
    return (shape.passes == Passes::Steps || shape.effects.rays != 0) && shape.maxBounces > 1;
}

std::vector<ModuleKey> requiredModules(const PackageShape& shape) {
    std::vector<ModuleKey> keys;
    for (const RoleInfo& info : roles()) {
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

std::vector<std::string> featuresOf(std::span<const std::uint32_t> words) {
    // Capabilities come first in a module (SPIR-V 2.4).
    constexpr std::size_t kHeaderWords = 5;
    constexpr std::uint32_t kOpCapability = 2U << 16U | 17U;
    std::vector<std::string> features;
    for (std::size_t at = kHeaderWords; at + 1 < words.size() && words[at] == kOpCapability; at += 2) {
        const auto* const known =
            std::ranges::find(kCapabilities, words[at + 1], &CapabilityFeature::capability);
        const std::string feature = known == std::end(kCapabilities)
                                        ? "SPIR-V capability " + std::to_string(words[at + 1])
                                        : known->feature;
        if (!feature.empty()) {
            features.push_back(feature);
        }
    }
    std::ranges::sort(features);
    features.erase(std::unique(features.begin(), features.end()), features.end());
    return features;
}

}  // namespace glint::package

#include "ray_passes.h"

#include "ray_pipelines.h"

#include <utility>

namespace glint {
namespace {

using package::ModuleRole;

// Keeps the pipeline; its passes, one a ray generation shader of the source.
Result<std::vector<PassPipeline>> addRayPipeline(Context::State& context, const RayPipelineSource& source,
                                                 Pipelines& pipelines) {
    Result<RayPipeline> made = createRayPipeline(context, pipelines.pool, pipelines.layout.get(), source);
    if (!made) {
        return made.error();
    }
    std::vector<PassPipeline> passes;
    for (const VkStridedDeviceAddressRegionKHR& rayGeneration : made->table.rayGeneration) {
        passes.push_back({made->pipeline.get(), true, rayGeneration, made->table.miss, made->table.hit});
    }
    pipelines.owned.push_back(std::move(made->pipeline));
    pipelines.tables.push_back(std::move(made->table.buffer));
    return passes;
}

SpirvWords rayWords(const Package& package, ModuleRole role, std::uint32_t index = 0) {
    return package.spirv({role, index, package::kTracerRayPipeline});
}

// Of passes that only trace: what rays find is shaded elsewhere.
RayPipelineSource tracingSource(const Package& package, std::vector<SpirvWords> rayGeneration) {
    RayPipelineSource source;
    source.rayGeneration = std::move(rayGeneration);
    source.miss = {rayWords(package, ModuleRole::TraceMiss)};
    source.closestHit = {rayWords(package, ModuleRole::TraceClosestHit)};
    source.anyHit = rayWords(package, ModuleRole::TraceAnyHit);
    return source;
}

// Of the strategy hit-shaders: a record for each geometry, with the hit group of its shader ID.
RayPipelineSource hitShaderSource(const Package& package, std::span<const std::uint32_t> shaderIds) {
    RayPipelineSource source;
    source.rayGeneration = {rayWords(package, ModuleRole::HitTrace)};
    // By miss index: rays of the list, shadow rays.
    source.miss = {rayWords(package, ModuleRole::HitMiss), rayWords(package, ModuleRole::TraceMiss)};
    source.anyHit = rayWords(package, ModuleRole::TraceAnyHit);
    std::map<std::uint32_t, std::uint32_t> groups;  // by shader ID; retired ones have none
    std::map<const std::uint32_t*, std::uint32_t> byWords;
    for (std::uint32_t shaderId = 0; shaderId < package.caseCount(); ++shaderId) {
        const SpirvWords words = rayWords(package, ModuleRole::HitCase, shaderId);
        if (words.empty()) {
            continue;
        }
        const auto [known, fresh] =
            byWords.emplace(words.data(), static_cast<std::uint32_t>(source.closestHit.size()));
        if (fresh) {
            source.closestHit.push_back(words);
        }
        groups[shaderId] = known->second;
    }
    const auto unknown = static_cast<std::uint32_t>(source.closestHit.size());
    source.closestHit.push_back(rayWords(package, ModuleRole::HitUnknown));
    for (const std::uint32_t shaderId : shaderIds) {
        const auto group = groups.find(shaderId);
        source.hitRecords.push_back(group != groups.end() ? group->second : unknown);
    }
    return source;
}

// Cases that trace their shadow rays: one pipeline, a ray generation shader for each distinct module.
Status createRayCases(Context::State& context, const Package& package, Pipelines& pipelines) {
    std::vector<SpirvWords> shaders;
    std::map<std::uint32_t, std::size_t> shaderOfCase;  // by shader ID; retired ones have none
    std::map<const std::uint32_t*, std::size_t> byWords;
    for (std::uint32_t shaderId = 0; shaderId < package.caseCount(); ++shaderId) {
        const SpirvWords words = rayWords(package, ModuleRole::ShadeCase, shaderId);
        if (words.empty()) {
            continue;
        }
        const auto [known, fresh] = byWords.emplace(words.data(), shaders.size());
        if (fresh) {
            shaders.push_back(words);
        }
        shaderOfCase[shaderId] = known->second;
    }
    if (shaders.empty()) {
        return okStatus();
    }
    Result<std::vector<PassPipeline>> passes =
        addRayPipeline(context, tracingSource(package, std::move(shaders)), pipelines);
    if (!passes) {
        return passes.error();
    }
    pipelines.cases.resize(package.caseCount());
    for (const auto& [shaderId, shader] : shaderOfCase) {
        pipelines.cases[shaderId] = (*passes)[shader];
    }
    return okStatus();
}

}  // namespace

Status createRayPasses(Context::State& context, const Package& package, const PipelineChoice& choice,
                       std::span<const std::uint32_t> shaderIds, Pipelines& pipelines) {
    bool tracesInCases = false;
    for (const package::ModuleKey& key : package::requiredModules(chosenShape(package, choice))) {
        const package::ShaderKind kind = package::findRole(key.role)->kind;
        const bool generatesRays =
            kind == package::ShaderKind::Tracing || kind == package::ShaderKind::RayGeneration;
        if (key.tracer != package::kTracerRayPipeline || !generatesRays) {
            continue;
        }
        if (key.role == ModuleRole::ShadeCase) {
            tracesInCases = true;
            continue;
        }
        Result<std::vector<PassPipeline>> passes =
            addRayPipeline(context,
                           key.role == ModuleRole::HitTrace ? hitShaderSource(package, shaderIds)
                                                            : tracingSource(package, {package.spirv(key)}),
                           pipelines);
        if (!passes) {
            return passes.error();
        }
        pipelines.passes[key.role] = passes->front();
    }
    return tracesInCases ? createRayCases(context, package, pipelines) : okStatus();
}

}  // namespace glint

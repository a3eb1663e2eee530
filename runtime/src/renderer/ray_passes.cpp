#include "renderer/ray_passes.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace glint {
namespace {

using package::ModuleRole;

SpirvWords rayWords(const Package& package, ModuleRole role, std::uint32_t index = 0) {
    return package.spirv({role, index, package::kTracerRayPipeline});
}

// Returns the source of passes that only trace. Other passes shade what their rays find.
RayPipelineSource tracingSource(const Package& package, SpirvWords rayGeneration) {
    RayPipelineSource source;
    source.rayGeneration = rayGeneration;
    source.miss = {rayWords(package, ModuleRole::TraceMiss)};
    source.closestHit = {rayWords(package, ModuleRole::TraceClosestHit)};
    source.anyHit = rayWords(package, ModuleRole::TraceAnyHit);
    return source;
}

// Returns the source of the strategy hit-shaders, without closest-hit shaders.
RayPipelineSource hitShaderStart(const Package& package) {
    RayPipelineSource source;
    source.rayGeneration = rayWords(package, ModuleRole::HitTrace);
    // The miss indices are those of rays in the list and of shadow rays, in this order.
    source.miss = {rayWords(package, ModuleRole::HitMiss), rayWords(package, ModuleRole::TraceMiss)};
    source.anyHit =
        rayWords(package, package.shape().shadowsApart ? ModuleRole::HitAnyHit : ModuleRole::TraceAnyHit);
    return source;
}

// Returns the source of the strategy hit-shaders. Each geometry has a record, with the hit group of its
// shader ID.
RayPipelineSource hitShaderSource(const Package& package, std::span<const std::uint32_t> shaderIds) {
    RayPipelineSource source = hitShaderStart(package);
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
    const SpirvWords fallback = rayWords(package, ModuleRole::HitFallback);
    source.closestHit.push_back(fallback.empty() ? rayWords(package, ModuleRole::HitUnknown) : fallback);
    for (const std::uint32_t shaderId : shaderIds) {
        const auto group = groups.find(shaderId);
        source.hitRecords.push_back(group != groups.end() ? group->second : unknown);
    }
    return source;
}

// Plans the strategy hit-shaders with the fallback for every hit.
RayPipelineSource hitFallbackSource(const Package& package) {
    RayPipelineSource source = hitShaderStart(package);
    source.closestHit = {rayWords(package, ModuleRole::HitFallback)};
    return source;
}

// Plans the cases that trace their own shadow rays. Each distinct module has a pipeline, so that threads can
// make several at once: one pipeline for all took a driver six times as long for 256 cases (docs/live.md).
std::vector<RayPass> planCases(const Package& package, const PipelineChoice& choice) {
    std::vector<RayPass> passes;
    std::map<const std::uint32_t*, std::size_t> byWords;
    for (std::uint32_t shaderId = 0; shaderId < package.caseCount(); ++shaderId) {
        const SpirvWords words = rayWords(package, ModuleRole::ShadeCase, shaderId);
        if (words.empty()) {
            continue;
        }
        const auto [known, fresh] = byWords.emplace(words.data(), passes.size());
        if (fresh) {
            RayPass& pass = passes.emplace_back();
            pass.key = {ModuleRole::ShadeCase, shaderId, package::kTracerRayPipeline};
            pass.name = pipelineName(package, pass.key);
            pass.source = tracingSource(package, words);
            pass.later = isMadeLater(choice, pass.key.role);
        }
        passes[known->second].shaderIds.push_back(shaderId);
    }
    return passes;
}

}  // namespace

std::vector<RayPass> planRayPasses(const Package& package, const PipelineChoice& choice,
                                   std::span<const std::uint32_t> shaderIds) {
    std::vector<RayPass> passes;
    bool tracesInCases = false;
    for (const package::ModuleKey& key : package::requiredModules(chosenShape(package, choice))) {
        const package::ShaderKind kind = package::findRole(key.role)->kind;
        const bool generatesRays =
            kind == package::ShaderKind::Tracing || kind == package::ShaderKind::RayGeneration;
        if (key.tracer != package::kTracerRayPipeline || !generatesRays || !runsFallback(choice, key.role)) {
            continue;
        }
        if (key.role == ModuleRole::ShadeCase) {
            tracesInCases = true;
            continue;
        }
        RayPass pass;
        pass.name = pipelineName(package, key);
        pass.key = key;
        pass.later = isMadeLater(choice, key.role);
        if (key.role != ModuleRole::HitTrace) {
            pass.source = tracingSource(package, package.spirv(key));
        } else {
            if (choice.background) {
                RayPass& fallback = passes.emplace_back(pass);
                fallback.later = false;
                fallback.source = hitFallbackSource(package);
            }
            pass.source = hitShaderSource(package, shaderIds);
        }
        passes.push_back(std::move(pass));
    }
    if (tracesInCases) {
        std::ranges::move(planCases(package, choice), std::back_inserter(passes));
    }
    return passes;
}

std::size_t wordCount(const RayPipelineSource& source) {
    std::size_t count = source.rayGeneration.size() + source.anyHit.size();
    for (const auto* const stages : {&source.miss, &source.closestHit}) {
        for (const SpirvWords words : *stages) {
            count += words.size();
        }
    }
    return count;
}

Status addRayPass(Context::State& context, const RayPass& pass, VkPipeline pipeline, Pipelines& pipelines) {
    Result<ShaderBindingTable> table = createTable(context, pipelines.pool, pipeline, pass.source);
    if (!table) {
        return table.error();
    }
    const PassPipeline made{pipeline, true, table->rayGeneration, table->miss, table->hit};
    if (pass.key.role == ModuleRole::ShadeCase) {
        for (const std::uint32_t shaderId : pass.shaderIds) {
            pipelines.cases[shaderId] = made;
        }
    } else {
        pipelines.add(pass.key, made);
    }
    pipelines.tables.push_back(std::move(table->buffer));
    return okStatus();
}

}  // namespace glint

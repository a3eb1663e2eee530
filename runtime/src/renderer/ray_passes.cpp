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

// Returns the source of passes that only trace. Other passes shade the hits of their rays.
RayPipelineSource tracingSource(const Package& package, SpirvWords rayGeneration) {
    RayPipelineSource source;
    source.rayGeneration = rayGeneration;
    source.miss = {rayWords(package, ModuleRole::TraceMiss)};
    source.closestHit = {rayWords(package, ModuleRole::TraceClosestHit)};
    source.anyHit = rayWords(package, ModuleRole::TraceAnyHit);
    return source;
}

// The roles of a strategy with a pipeline of its own.
struct HitShaderRoles {
    ModuleRole rayGeneration{};
    ModuleRole caseHit{};     // closest hit of a case
    ModuleRole unknownHit{};  // of a geometry whose shader ID no case has
    ModuleRole fallbackHit{};
    ModuleRole miss{};
    ModuleRole anyHit{};
};

HitShaderRoles hitShaderRoles(package::Strategy strategy) {
    HitShaderRoles roles;
    for (const package::RoleInfo& info : package::rolesOf(strategy)) {
        switch (info.kind) {
            case package::ShaderKind::RayGeneration:
                roles.rayGeneration = info.role;
                break;
            case package::ShaderKind::ClosestHit:
                if (info.fallback != ModuleRole::None) {
                    roles.caseHit = info.role;
                    roles.fallbackHit = info.fallback;
                } else if (info.purpose != package::Purpose::Fallback) {
                    roles.unknownHit = info.role;
                }
                break;
            case package::ShaderKind::Miss:
                roles.miss = info.role;
                break;
            case package::ShaderKind::AnyHit:
                roles.anyHit = info.role;
                break;
            default:
                break;
        }
    }
    return roles;
}

// Returns the source of a pipeline of a strategy's own, without closest-hit shaders.
RayPipelineSource hitShaderStart(const Package& package, const HitShaderRoles& roles) {
    RayPipelineSource source;
    source.rayGeneration = rayWords(package, roles.rayGeneration);
    // The miss indices are those of rays in the list and of shadow rays, in this order.
    source.miss = {rayWords(package, roles.miss), rayWords(package, ModuleRole::TraceMiss)};
    source.anyHit = rayWords(package, package.shape().shadowsApart ? roles.anyHit : ModuleRole::TraceAnyHit);
    return source;
}

// Returns the source of a strategy's own pipeline. Each geometry has a record, with the hit group of its
// shader ID.
RayPipelineSource hitShaderSource(const Package& package, const HitShaderRoles& roles,
                                  std::span<const std::uint32_t> shaderIds) {
    RayPipelineSource source = hitShaderStart(package, roles);
    std::map<std::uint32_t, std::uint32_t> groups;  // by shader ID; retired ones have none
    std::map<const std::uint32_t*, std::uint32_t> byWords;
    for (std::uint32_t shaderId = 0; shaderId < package.caseCount(); ++shaderId) {
        const SpirvWords words = rayWords(package, roles.caseHit, shaderId);
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
    const SpirvWords fallback = rayWords(package, roles.fallbackHit);
    source.closestHit.push_back(fallback.empty() ? rayWords(package, roles.unknownHit) : fallback);
    for (const std::uint32_t shaderId : shaderIds) {
        const auto group = groups.find(shaderId);
        source.hitRecords.push_back(group != groups.end() ? group->second : unknown);
    }
    return source;
}

// Returns the source of a strategy's own pipeline with the fallback for every hit.
RayPipelineSource hitFallbackSource(const Package& package, const HitShaderRoles& roles) {
    RayPipelineSource source = hitShaderStart(package, roles);
    source.closestHit = {rayWords(package, roles.fallbackHit)};
    return source;
}

// Plans the cases that trace their own shadow rays. Each distinct module has a pipeline, so that threads can
// make several at once: one pipeline for all took a driver six times as long for 256 cases (docs/live.md).
std::vector<RayPass> planCases(const Package& package, const PipelineChoice& choice, ModuleRole role) {
    std::vector<RayPass> passes;
    std::map<const std::uint32_t*, std::size_t> byWords;
    for (std::uint32_t shaderId = 0; shaderId < package.caseCount(); ++shaderId) {
        const SpirvWords words = rayWords(package, role, shaderId);
        if (words.empty()) {
            continue;
        }
        const auto [known, fresh] = byWords.emplace(words.data(), passes.size());
        if (fresh) {
            RayPass& pass = passes.emplace_back();
            pass.key = {role, shaderId, package::kTracerRayPipeline};
            pass.name = pipelineName(package, pass.key);
            pass.source = tracingSource(package, words);
            pass.turn = turnOf(choice, role);
        }
        passes[known->second].shaderIds.push_back(shaderId);
    }
    return passes;
}

}  // namespace

std::vector<RayPass> planRayPasses(const Package& package, const PipelineChoice& choice,
                                   std::span<const std::uint32_t> shaderIds) {
    std::vector<RayPass> passes;
    ModuleRole ofCases = ModuleRole::None;  // of cases that trace their own shadow rays
    for (const package::ModuleKey& key : package::requiredModules(chosenShape(package, choice))) {
        const package::RoleInfo& info = *package::findRole(key.role);
        const bool generatesRays = info.kind == package::ShaderKind::Tracing ||
                                   info.kind == package::ShaderKind::Shading ||
                                   info.kind == package::ShaderKind::RayGeneration;
        if (key.tracer != package::kTracerRayPipeline || !generatesRays || !runsFallback(choice, key.role)) {
            continue;
        }
        if (info.over == package::Over::Buckets) {
            ofCases = key.role;
            continue;
        }
        RayPass pass;
        pass.name = pipelineName(package, key);
        pass.key = key;
        pass.turn = turnOf(choice, key.role);
        if (info.kind != package::ShaderKind::RayGeneration) {
            pass.source = tracingSource(package, package.spirv(key));
        } else {
            const HitShaderRoles roles = hitShaderRoles(choice.strategy);
            if (choice.background) {
                RayPass& fallback = passes.emplace_back(pass);
                fallback.name = pipelineName(package, {roles.fallbackHit, 0, key.tracer});
                fallback.turn = choice.draft ? PipelineTurn::Fixed : PipelineTurn::First;
                fallback.source = hitFallbackSource(package, roles);
            }
            pass.source = hitShaderSource(package, roles, shaderIds);
        }
        passes.push_back(std::move(pass));
    }
    if (ofCases != ModuleRole::None) {
        std::ranges::move(planCases(package, choice, ofCases), std::back_inserter(passes));
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
    GLINT_TRY(auto table, createTable(context, pipelines.pool, pipeline, pass.source));
    const PassPipeline made{pipeline, true, table.rayGeneration, table.miss, table.hit};
    if (package::findRole(pass.key.role)->over == package::Over::Buckets) {
        for (const std::uint32_t shaderId : pass.shaderIds) {
            pipelines.cases[shaderId] = made;
        }
    } else {
        pipelines.add(pass.key, made);
    }
    pipelines.tables.push_back(std::move(table.buffer));
    return okStatus();
}

}  // namespace glint

#include "emit/modules.h"

#include "emit/context.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

namespace glint {

using package::ModuleRole;

namespace {

constexpr std::uint32_t kBothStrategies = package::kStrategyUber | package::kStrategyVisibility;
// File systems allow 255 bytes; the shader ID alone makes a name unique.
constexpr std::size_t kMaxCaseNameLength = 100;

// A pass: its source below shaders/, or its template, and which strategies dispatch it.
struct PassInfo {
    ModuleRole role;
    std::string_view roleName;
    ShaderStage stage;
    std::uint32_t strategies;
    std::string_view source;
};

constexpr PassInfo kPasses[] = {
    {ModuleRole::GBufferVertex, "GBufferVertex", ShaderStage::Vertex, kBothStrategies, "passes/gbuffer.vert"},
    {ModuleRole::GBufferFragment, "GBufferFragment", ShaderStage::Fragment, kBothStrategies,
     "passes/gbuffer.frag"},
    {ModuleRole::Lighting, "Lighting", ShaderStage::Compute, kBothStrategies, "passes/lighting.comp"},
    {ModuleRole::ReflectionRays, "ReflectionRays", ShaderStage::Compute, kBothStrategies,
     "passes/reflection_rays.comp"},
    {ModuleRole::RayDispatch, "RayDispatch", ShaderStage::Compute, kBothStrategies,
     "passes/ray_dispatch.comp"},
    {ModuleRole::UberShade, "UberShade", ShaderStage::Compute, package::kStrategyUber, "uber.comp.mustache"},
    {ModuleRole::Trace, "Trace", ShaderStage::Compute, package::kStrategyVisibility, "passes/trace.comp"},
    {ModuleRole::BucketCount, "BucketCount", ShaderStage::Compute, package::kStrategyVisibility,
     "passes/bucket_count.comp"},
    {ModuleRole::BucketOffset, "BucketOffset", ShaderStage::Compute, package::kStrategyVisibility,
     "passes/bucket_offset.comp"},
    {ModuleRole::BucketCopy, "BucketCopy", ShaderStage::Compute, package::kStrategyVisibility,
     "passes/bucket_copy.comp"},
    {ModuleRole::ShadeMiss, "ShadeMiss", ShaderStage::Compute, package::kStrategyVisibility,
     "passes/shade_miss.comp"},
    {ModuleRole::ShadeCase, "ShadeCase", ShaderStage::Compute, package::kStrategyVisibility,
     "shade_case.comp.mustache"},
    {ModuleRole::Compose, "Compose", ShaderStage::Compute, kBothStrategies, "passes/compose.comp"},
};

constexpr std::string_view kTemplateSuffix = ".mustache";

// "uber.comp" is compiled to uber.spv; other stages keep theirs in the name: gbuffer.vert.spv.
std::string spirvFileName(const ModuleSource& source) {
    constexpr std::string_view kComputeSuffix = ".comp";
    std::string_view stem = source.name;
    if (stem.ends_with(kComputeSuffix)) {
        stem.remove_suffix(kComputeSuffix.size());
    }
    return std::string(stem) + ".spv";
}

Result<ModuleSource> makeModule(const PassInfo& pass, std::string name, const SourceSet& sources,
                                const kainjow::mustache::data& context) {
    ModuleSource module{pass.role, 0, pass.stage, std::move(name), {}, {}};
    std::string text;
    std::string origin(pass.source);
    if (pass.source.ends_with(kTemplateSuffix)) {
        Result<std::string> rendered = renderTemplate(sources, pass.source, context);
        if (!rendered) {
            return rendered.error();
        }
        text = std::move(*rendered);
        origin = module.name;
    } else if (const std::optional<std::string_view> found = sources.find(pass.source)) {
        text = *found;
    } else {
        return makeError("source-include", origin, "there is no such shader");
    }
    Result<std::string> flattened = flatten(origin, text, sources.lookup(), FlattenSide::Glsl);
    if (!flattened) {
        return flattened.error();
    }
    module.glsl = std::move(*flattened);
    return module;
}

Result<CompiledModule> compileModule(ModuleSource& source, bool debugInfo) {
    Result<std::vector<std::uint32_t>> spirv =
        compileShader({source.name, source.stage, source.glsl, source.functionsApart}, {debugInfo});
    if (!spirv) {
        return spirv.error();
    }
    Result<SpirvStatistics> statistics = measureSpirv(*spirv);
    if (!statistics) {
        return statistics.error();
    }
    CompiledModule module;
    module.role = source.role;
    module.shaderId = source.shaderId;
    module.file = spirvFileName(source);
    module.name = std::move(source.name);
    module.glsl = std::move(source.glsl);
    module.spirv = std::move(*spirv);
    module.statistics = *statistics;
    module.hash = hashBytes({reinterpret_cast<const std::uint8_t*>(module.spirv.data()),
                             module.spirv.size() * sizeof(std::uint32_t)});
    return module;
}

// Runs work(0) … work(count - 1), handed out in order; stops handing out after a false.
template <typename Work>
void runParallel(std::size_t count, int jobs, const Work& work) {
    std::atomic<std::size_t> next{0};
    std::atomic<bool> failed{false};
    const auto loop = [&] {
        for (std::size_t i = next++; i < count && !failed; i = next++) {
            if (!work(i)) {
                failed = true;
            }
        }
    };
    const std::size_t wanted =
        jobs > 0 ? static_cast<std::size_t>(jobs) : std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> threads;
    try {
        // This thread works too.
        for (std::size_t i = 1; i < std::min(wanted, count); ++i) {
            threads.emplace_back(loop);
        }
    } catch (const std::system_error&) {
        // No more threads to be had: those that there are do the work.
    }
    loop();
}

// Equal hashes only hint at equal modules; equal words prove it.
void shareFiles(std::vector<CompiledModule>& modules) {
    std::multimap<std::uint64_t, std::size_t> firsts;
    for (std::size_t i = 0; i < modules.size(); ++i) {
        const auto [begin, end] = firsts.equal_range(modules[i].hash);
        const auto twin = std::find_if(
            begin, end, [&](const auto& entry) { return modules[entry.second].spirv == modules[i].spirv; });
        if (twin != end) {
            modules[i].file = modules[twin->second].file;
        } else {
            firsts.emplace(modules[i].hash, i);
        }
    }
}

}  // namespace

std::string_view toString(ModuleRole role) {
    const auto* const pass = std::ranges::find(kPasses, role, &PassInfo::role);
    return pass == std::end(kPasses) ? "unknown" : pass->roleName;
}

Result<std::vector<ModuleSource>> makeModuleSources(const Scene& scene, const Plan& plan,
                                                    const SourceSet& sources,
                                                    const CompileSettings& settings) {
    kainjow::mustache::data context = makeContext(scene, plan, settings.plan);
    std::vector<ModuleSource> modules;
    for (const PassInfo& pass : kPasses) {
        if ((pass.strategies & settings.strategies) == 0) {
            continue;
        }
        if (pass.role != ModuleRole::ShadeCase) {
            std::string name(pass.source.substr(pass.source.find('/') + 1));
            if (name.ends_with(kTemplateSuffix)) {
                name.resize(name.size() - kTemplateSuffix.size());
            }
            Result<ModuleSource> module = makeModule(pass, std::move(name), sources, context);
            if (!module) {
                return module.error();
            }
            if (pass.role == ModuleRole::UberShade) {
                for (const Case& shaderCase : plan.cases) {
                    module->functionsApart.push_back("shade" + shaderCase.name);
                }
            }
            modules.push_back(std::move(*module));
            continue;
        }
        for (const Case& shaderCase : plan.cases) {
            addCase(context, scene, shaderCase);
            const std::string name = fmt::format("shade_{}_{}.comp", shaderCase.shaderId,
                                                 shaderCase.name.substr(0, kMaxCaseNameLength));
            Result<ModuleSource> module = makeModule(pass, name, sources, context);
            if (!module) {
                return module.error();
            }
            module->shaderId = shaderCase.shaderId;
            modules.push_back(std::move(*module));
        }
    }
    return modules;
}

Result<std::vector<CompiledModule>> compileModules(std::vector<ModuleSource> sources, int jobs,
                                                   bool debugInfo) {
    std::vector<std::optional<Result<CompiledModule>>> results(sources.size());
    runParallel(sources.size(), jobs, [&](std::size_t i) {
        results[i] = compileModule(sources[i], debugInfo);
        return results[i]->ok();
    });
    // Modules are handed out in order, so that every one before the first error has a result.
    std::vector<CompiledModule> modules;
    for (std::optional<Result<CompiledModule>>& result : results) {
        if (!result->ok()) {
            return result->error();
        }
        modules.push_back(std::move(**result));
    }
    shareFiles(modules);
    return modules;
}

}  // namespace glint

#include "emit/modules.h"

#include "cache/module_cache.h"
#include "cache/packing.h"
#include "emit/context.h"
#include "emit/prune.h"

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

// File systems allow 255 bytes; the shader ID alone makes a name unique.
constexpr std::size_t kMaxCaseNameLength = 100;

// Where a role's GLSL is: below shaders/, or a template.
struct RoleSource {
    ModuleRole role;
    std::string_view source;
};

constexpr RoleSource kSources[] = {
    {ModuleRole::GBufferVertex, "passes/gbuffer.vert"},
    {ModuleRole::GBufferFragment, "passes/gbuffer.frag"},
    {ModuleRole::Lighting, "passes/lighting.comp"},
    {ModuleRole::ReflectionRays, "passes/reflection_rays.comp"},
    {ModuleRole::RayDispatch, "passes/ray_dispatch.comp"},
    {ModuleRole::UberShade, "passes/uber.comp"},
    {ModuleRole::Trace, "passes/trace.comp"},
    {ModuleRole::BucketCount, "passes/bucket_count.comp"},
    {ModuleRole::BucketOffset, "passes/bucket_offset.comp"},
    {ModuleRole::BucketCopy, "passes/bucket_copy.comp"},
    {ModuleRole::ShadeMiss, "passes/shade_miss.comp"},
    {ModuleRole::ShadeCase, "shade_case.comp.mustache"},
    {ModuleRole::Compose, "passes/compose.comp"},
    {ModuleRole::SortedShade, "passes/sorted_shade.comp"},
    {ModuleRole::ShadowDispatch, "passes/shadow_dispatch.comp"},
    {ModuleRole::ShadowTrace, "passes/shadow_trace.comp"},
    {ModuleRole::OrderCheck, "passes/order_check.comp"},
    {ModuleRole::TraceClosestHit, "passes/trace.rchit"},
    {ModuleRole::TraceAnyHit, "passes/trace.rahit"},
    {ModuleRole::TraceMiss, "passes/trace.rmiss"},
    {ModuleRole::HitTrace, "passes/hit_trace.rgen"},
    {ModuleRole::HitCase, "hit_case.rchit.mustache"},
    {ModuleRole::HitUnknown, "passes/hit_unknown.rchit"},
    {ModuleRole::HitMiss, "passes/hit_miss.rmiss"},
};

ShaderStage stageOf(const package::RoleInfo& info, std::uint32_t tracer) {
    switch (info.kind) {
        case package::ShaderKind::Vertex:
            return ShaderStage::Vertex;
        case package::ShaderKind::Fragment:
            return ShaderStage::Fragment;
        case package::ShaderKind::Compute:
            return ShaderStage::Compute;
        case package::ShaderKind::Tracing:
            return tracer == package::kTracerRayPipeline ? ShaderStage::RayGeneration : ShaderStage::Compute;
        case package::ShaderKind::RayGeneration:
            return ShaderStage::RayGeneration;
        case package::ShaderKind::ClosestHit:
            return ShaderStage::ClosestHit;
        case package::ShaderKind::AnyHit:
            return ShaderStage::AnyHit;
        case package::ShaderKind::Miss:
            return ShaderStage::Miss;
    }
    return ShaderStage::Compute;
}

constexpr std::string_view kTemplateSuffix = ".mustache";
constexpr std::string_view kComputeSuffix = ".comp";

// "passes/lighting.comp" gives lighting.comp, or lighting.rgen where it is a ray generation shader; what
// there are several of says which it is.
std::string moduleName(std::string_view source, const package::RoleInfo& info, const package::ModuleKey& key,
                       std::string_view caseName) {
    std::string name(source.substr(source.find('/') + 1));
    if (name.ends_with(kTemplateSuffix)) {
        name.resize(name.size() - kTemplateSuffix.size());
    }
    const std::size_t dot = name.rfind('.');
    std::string extension = name.substr(dot);
    name.resize(dot);
    if (info.repeated == package::Repeated::ByCase) {
        // "shade_case" gives shade_2_BaseTex.
        name.resize(name.rfind('_') + 1);
        name += fmt::format("{}_{}", key.index, caseName.substr(0, kMaxCaseNameLength));
    } else if (info.repeated == package::Repeated::ByOrdering) {
        name += fmt::format("_{}", package::nameOf(static_cast<package::Ordering>(key.index)));
        std::ranges::replace(name, '-', '_');
    }
    if (extension == kComputeSuffix && stageOf(info, key.tracer) == ShaderStage::RayGeneration) {
        extension = ".rgen";
    }
    return name + extension;
}

// What a module knows of itself, before anything else of its text.
std::string moduleDefines(const package::RoleInfo& info, const package::ModuleKey& key) {
    std::string defines;
    const ShaderStage stage = stageOf(info, key.tracer);
    if (stage != ShaderStage::Vertex && stage != ShaderStage::Fragment) {
        defines += fmt::format("#define GLINT_TRACER {}\n#define GLINT_RAY_GENERATION {}\n", key.tracer,
                               stage == ShaderStage::RayGeneration ? 1 : 0);
    }
    if (info.repeated == package::Repeated::ByOrdering) {
        defines += fmt::format("#define GLINT_ORDERING {}\n", key.index);
    }
    return defines;
}

// After the line of #version, which has to come first.
void insertDefines(std::string& text, const std::string& defines) {
    if (!defines.empty()) {
        text.insert(text.find('\n') + 1, defines + "#line 2\n");
    }
}

// "uber.comp" is compiled to uber.spv; other stages keep theirs in the name: gbuffer.vert.spv.
std::string spirvFileName(const ModuleSource& source) {
    std::string_view stem = source.name;
    if (stem.ends_with(kComputeSuffix)) {
        stem.remove_suffix(kComputeSuffix.size());
    }
    return std::string(stem) + ".spv";
}

Result<ModuleSource> makeModule(std::string_view source, const package::ModuleKey& key,
                                std::string_view caseName, const SourceSet& sources,
                                const kainjow::mustache::data& context) {
    const package::RoleInfo& info = *package::findRole(key.role);
    ModuleSource module{key, stageOf(info, key.tracer), moduleName(source, info, key, caseName), {}, {}};
    std::string text;
    std::string origin(source);
    if (source.ends_with(kTemplateSuffix)) {
        Result<std::string> rendered = renderTemplate(sources, source, context);
        if (!rendered) {
            return rendered.error();
        }
        text = std::move(*rendered);
        origin = module.name;
    } else if (const std::optional<std::string_view> found = sources.find(source)) {
        text = *found;
    } else {
        return makeError("source-include", origin, "there is no such shader");
    }
    insertDefines(text, moduleDefines(info, key));
    Result<std::string> flattened = flatten(origin, text, sources.lookup(), FlattenSide::Glsl);
    if (!flattened) {
        return flattened.error();
    }
    module.glsl = dropUnused(*flattened);
    return module;
}

// All that decides about the words of a module, apart from the compiler.
std::string compiledSource(const ModuleSource& source, bool debugInfo) {
    Packer packer;
    packer.add(static_cast<std::uint64_t>(source.stage)).add(source.functionsApart.size());
    for (const std::string& function : source.functionsApart) {
        packer.add(std::string_view(function));
    }
    if (debugInfo) {
        packer.add(std::string_view(source.name)).add(std::string_view(source.glsl));
    } else {
        packer.add(essentialText(source.glsl));
    }
    return packer.take();
}

// Of one text, which several modules may have.
struct CompiledText {
    CachedModule module;
    bool compiled = false;
};

Result<CompiledText> compileText(const ModuleSource& source, const std::string& key, bool debugInfo,
                                 ModuleCache* cache) {
    if (cache != nullptr) {
        if (std::optional<CachedModule> found = cache->find(key)) {
            return CompiledText{std::move(*found), false};
        }
    }
    Result<std::vector<std::uint32_t>> spirv =
        compileShader({source.name, source.stage, source.glsl, source.functionsApart}, {debugInfo});
    if (!spirv) {
        return spirv.error();
    }
    Result<SpirvStatistics> statistics = measureSpirv(*spirv);
    if (!statistics) {
        return statistics.error();
    }
    CompiledText text{{std::move(*spirv), *statistics}, true};
    if (cache != nullptr) {
        cache->put(key, text.module);
    }
    return text;
}

CompiledModule makeCompiled(ModuleSource& source, const CompiledText& text, bool isFirst) {
    CompiledModule module;
    module.key = source.key;
    module.file = spirvFileName(source);
    module.name = std::move(source.name);
    module.glsl = std::move(source.glsl);
    module.spirv = text.module.spirv;
    module.statistics = text.module.statistics;
    module.hash = hashBytes({reinterpret_cast<const std::uint8_t*>(module.spirv.data()),
                             module.spirv.size() * sizeof(std::uint32_t)});
    module.compiled = text.compiled && isFirst;
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

std::vector<std::uint32_t> retiredIds(const Plan& plan) {
    std::vector<std::uint32_t> ids;
    for (const Case& shaderCase : plan.cases) {
        if (shaderCase.isRetired()) {
            ids.push_back(static_cast<std::uint32_t>(shaderCase.shaderId));
        }
    }
    return ids;
}

}  // namespace

package::PackageShape shapeOf(const Plan& plan, const CompileSettings& settings) {
    return {settings.strategies,
            settings.tracers,
            settings.shadows,
            settings.plan.keys.alpha == AlphaPolicy::Tested,
            static_cast<std::uint32_t>(plan.cases.size()),
            retiredIds(plan)};
}

Result<std::vector<ModuleSource>> makeModuleSources(const SceneList& scenes, const Plan& plan,
                                                    const SourceSet& sources,
                                                    const CompileSettings& settings) {
    kainjow::mustache::data context = makeContext(scenes, plan, settings.plan);
    std::vector<ModuleSource> modules;
    for (const package::ModuleKey& key : package::requiredModules(shapeOf(plan, settings))) {
        const bool ofCase = package::findRole(key.role)->repeated == package::Repeated::ByCase;
        if (ofCase) {
            addCase(context, scenes, plan.cases[key.index]);
        }
        const auto* const source = std::ranges::find(kSources, key.role, &RoleSource::role);
        Result<ModuleSource> module =
            makeModule(source->source, key, ofCase ? std::string_view(plan.cases[key.index].name) : "",
                       sources, context);
        if (!module) {
            return module.error();
        }
        if (key.role == ModuleRole::UberShade || key.role == ModuleRole::SortedShade) {
            for (const Case& shaderCase : plan.cases) {
                if (!shaderCase.isRetired()) {
                    module->functionsApart.push_back("shade" + shaderCase.name);
                }
            }
        }
        modules.push_back(std::move(*module));
    }
    return modules;
}

Result<std::vector<CompiledModule>> compileModules(std::vector<ModuleSource> sources, int jobs,
                                                   bool debugInfo, ModuleCache* cache) {
    // Each text once, in the order of the modules.
    std::map<std::string, std::size_t> places;
    std::vector<std::map<std::string, std::size_t>::const_iterator> textOf;
    std::vector<std::size_t> firsts;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const auto [place, added] = places.emplace(compiledSource(sources[i], debugInfo), firsts.size());
        textOf.emplace_back(place);
        if (added) {
            firsts.push_back(i);
        }
    }
    std::vector<std::optional<Result<CompiledText>>> results(firsts.size());
    runParallel(firsts.size(), jobs, [&](std::size_t i) {
        results[i] = compileText(sources[firsts[i]], textOf[firsts[i]]->first, debugInfo, cache);
        return results[i]->ok();
    });
    // Texts are handed out in order, so that every one before the first error has a result.
    for (const std::optional<Result<CompiledText>>& result : results) {
        if (!result->ok()) {
            return result->error();
        }
    }
    std::vector<CompiledModule> modules;
    modules.reserve(sources.size());
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const std::size_t text = textOf[i]->second;
        modules.push_back(makeCompiled(sources[i], **results[text], firsts[text] == i));
    }
    shareFiles(modules);
    return modules;
}

}  // namespace glint

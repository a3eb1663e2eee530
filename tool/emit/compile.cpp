#include "emit/compile.h"

#include "base/clock.h"
#include "base/parallel.h"
#include "emit/compile_modules.h"
#include "emit/context.h"
#include "emit/effects.h"
#include "emit/glsl/readable.h"
#include "emit/layers.h"
#include "emit/library.h"
#include "emit/lights.h"
#include "emit/material_code.h"
#include "emit/module_files.h"
#include "emit/modules.h"
#include "emit/package/early.h"
#include "emit/package/header.h"
#include "emit/package/manifest.h"
#include "emit/package/tables.h"
#include "emit/sources.h"
#include "gltf/scene_list.h"
#include "spirv/compiler.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <new>
#include <set>
#include <utility>

namespace glint::compiler {

namespace {

base::Bytes toBytes(std::string_view text) {
    return {text.begin(), text.end()};
}

base::Bytes toBytes(const std::vector<std::uint32_t>& words) {
    const auto* const first = reinterpret_cast<const std::uint8_t*>(words.data());
    return {first, first + words.size() * sizeof(std::uint32_t)};
}

// Adds the modules' files. Modules with equal SPIR-V share one file.
void addModuleFiles(CompiledPackage& package, const std::string& source, bool emitGlsl) {
    std::set<std::string_view> written;
    for (const CompiledModule& module : package.modules) {
        if (written.insert(module.file).second) {
            package.files.push_back({module.file, toBytes(module.spirv)});
            package.spirvBytes += module.statistics.bytes;
            ++package.uniqueSpirv;
        }
        if (emitGlsl) {
            const std::string header = fmt::format("// Made by glint {} from {}. Do not edit.\n",
                                                   toolVersion(), commentText(source));
            package.files.push_back({"glsl/" + module.name, toBytes(makeReadable(module.glsl, header))});
        }
    }
}

Status checkPositionFetch(const CompileSettings& settings, const std::string& where) {
    if (!supportsPositionFetch()) {
        return makeError(
            "position-fetch", where,
            fmt::format(
                "position fetch needs GL_EXT_ray_tracing_position_fetch, which this glint's glslang {} "
                "does not know",
                glslangVersion()),
            "build glint with glslang 12.2 or newer, as Debian 13 has it, or leave out --position-fetch");
    }
    const std::uint32_t able = settings.strategies & ~package::orderedStrategies();
    const bool byQuery =
        (able & ~package::pipelineStrategies()) != 0 && (settings.tracers & package::kTracerRayQuery) != 0;
    if (!byQuery && (able & package::pipelineStrategies()) == 0) {
        return makeError("position-fetch", where,
                         fmt::format("no shader of this package could fetch positions: only {} with ray "
                                     "queries and {} can, because they shade a hit where they find it",
                                     fmt::join(strategyNames(~package::orderedStrategies() &
                                                             ~package::pipelineStrategies()),
                                               ", "),
                                     fmt::join(strategyNames(package::pipelineStrategies()), ", ")),
                         "add one of these strategies, or leave out --position-fetch");
    }
    return okStatus();
}

Status checkSettings(const CompileSettings& settings, const std::string& where) {
    if (settings.strategies == 0 || settings.strategies > package::allStrategies()) {
        return makeError(
            "strategy", where, fmt::format("{:#x} is no set of strategies", settings.strategies),
            fmt::format("choose among {}", fmt::join(strategyNames(package::allStrategies()), ", ")));
    }
    if (settings.tracers == 0 || settings.tracers > package::kAllTracers) {
        return makeError("tracer", where, fmt::format("{:#x} is no set of tracers", settings.tracers),
                         "choose ray-query, ray-pipeline or both");
    }
    if (settings.passes == package::Passes::Frame && settings.answer != package::HitAnswer::Radiance) {
        return makeError("passes", where, "a frame needs the radiance of its hits",
                         "add --passes steps, or leave out --answer surface");
    }
    if (settings.passes == package::Passes::Frame && settings.bindings != package::Bindings()) {
        return makeError("passes", where, "the renderer of whole frames has bindings of its own",
                         "add --passes steps, or leave out --bindings");
    }
    if (settings.passes == package::Passes::Steps && settings.textureLevels) {
        return makeError("passes", where,
                         "--texture-levels notes what a frame reads, and --passes steps has none",
                         "leave out --texture-levels, or --passes steps");
    }
    if (settings.maxBounces == 0 || settings.maxBounces > package::kMaxBounces) {
        return makeError("bounces", where,
                         fmt::format("paths of {} bounces cannot be followed", settings.maxBounces),
                         fmt::format("choose 1 to {}", package::kMaxBounces));
    }
    if (settings.passes == package::Passes::Steps && settings.maxBounces > 1) {
        return makeError("bounces", where, "the rays of an engine's own end at their first hit",
                         "leave out --bounces, or --passes steps");
    }
    if (settings.bindings.pushOffset % 8 != 0) {
        return makeError("bindings", where,
                         fmt::format("push-offset={} is no multiple of 8, which the addresses in the push "
                                     "constants need",
                                     settings.bindings.pushOffset),
                         "choose a multiple of 8");
    }
    return settings.positionFetch ? checkPositionFetch(settings, where) : okStatus();
}

// The results of all steps before SPIR-V.
struct Prepared {
    Plan plan;
    SourceSet sources;
    std::vector<ModuleSource> modules;
    bool shownEarly = false;
    double earlyMs = 0.0;  // that the early package took
};

// Returns whether an early package is shown. An error of it is not reported: the whole package has the same
// GLSL. `planMs` is how long planning took so far.
bool showEarly(const gltf::SceneList& scenes, const Plan& plan, const SourceSet& sources,
               const CompileSettings& settings, const EarlyShowing& showing, double planMs,
               WarmModules* warm) {
    Result<std::optional<CompiledPackage>> early =
        makeEarlyPackage(scenes, plan, sources, settings, *showing.before, warm);
    if (!early || !*early) {
        return false;
    }
    (*early)->planMs += planMs;
    return showing.publish(**early);
}

Result<Prepared> prepare(const gltf::SceneList& scenes, CompileSettings& settings, std::optional<Plan> made,
                         WarmModules* warm = nullptr, const EarlyShowing* showing = nullptr) {
    const base::Clock::time_point start = base::Clock::now();
    GLINT_TRY_DO(checkSettings(settings, scenes.path()));
    Plan plan = made ? std::move(*made) : makePlan(scenes.materials(), scenes.primitives(), settings.plan);
    plan.effects = planEffects(scenes, settings);
    GLINT_TRY(plan.layers, resolveLayers(plan, settings, scenes.path()));
    settings.shadowThrough = shadowThroughOf(scenes, plan, settings);
    if (const auto excess = describeExcess(plan, settings.plan)) {
        return makeError("max-shaders", scenes.path(), *excess);
    }
    GLINT_TRY(auto sources, makeSourceSet(scenes, plan, settings));
    const base::Clock::time_point planned = base::Clock::now();
    const bool shown = showing != nullptr && showEarly(scenes, plan, sources, settings, *showing,
                                                       base::millisecondsBetween(start, planned), warm);
    const double earlyMs = base::millisecondsSince(planned);
    const auto makeSources = [&] { return makeModuleSources(scenes, plan, sources, settings, warm); };
    GLINT_TRY(auto modules, shown ? base::runBehind(makeSources) : makeSources());
    return Prepared{std::move(plan), std::move(sources), std::move(modules), shown, earlyMs};
}

Result<CompiledPackage> compile(const gltf::SceneList& scenes, CompileSettings settings, ModuleCache* cache,
                                std::optional<Plan> made, WarmModules* warm, const EarlyShowing* showing) {
    const base::Clock::time_point start = base::Clock::now();
    GLINT_TRY(auto prepared, prepare(scenes, settings, std::move(made), warm, showing));
    const base::Clock::time_point planned = base::Clock::now();
    const auto compileAll = [&] {
        return compileModules(std::move(prepared.modules), settings.jobs, settings.debugInfo, cache, warm,
                              prepared.shownEarly ? showing->isOutdated : std::function<bool()>(),
                              settings.progress);
    };
    // The driver makes the pipeline of the early package at the same time, and that is awaited first.
    Result<std::vector<CompiledModule>> compiled =
        !settings.modules.empty()
            ? takeModules(std::move(prepared.modules), settings.debugInfo, settings.modules)
        : prepared.shownEarly ? base::runBehind(compileAll)
                              : compileAll();
    if (!compiled) {
        return explainGlslError(compiled.error(), *prepared.plan.model, settings.host);
    }
    const base::Clock::time_point haveSpirv = base::Clock::now();
    CompiledPackage package;
    package.plan = std::move(prepared.plan);
    package.modules = std::move(*compiled);

    // The manifest comes last, because it lists the other files.
    addModuleFiles(package, scenes.fileNames(), settings.emitGlsl);
    package.files.push_back(
        {package::kTablesFile, makeTables(scenes, package.plan, package.modules, settings)});
    if (settings.emitHeader) {
        GLINT_TRY(auto header, makeHeader(scenes, package.plan, prepared.sources, settings.plan));
        package.files.push_back({package::kHeaderFile, toBytes(header)});
    }
    if (settings.emitLibrary || settings.emitLinkable) {
        GLINT_TRY(auto library, makeLibrary(scenes, package.plan, settings, cache));
        std::ranges::move(library, std::back_inserter(package.files));
    }
    std::ranges::sort(package.files, {}, &PackageFile::name);
    package.files.push_back({package::kManifestFile, toBytes(makeManifest(scenes, package, settings))});
    std::ranges::sort(package.files, {}, &PackageFile::name);
    package.planMs = base::millisecondsBetween(start, planned) - prepared.earlyMs;
    package.earlyMs = prepared.shownEarly ? prepared.earlyMs : 0.0;
    package.compileMs = base::millisecondsBetween(planned, haveSpirv);
    package.tablesMs = base::millisecondsSince(haveSpirv);
    return package;
}

// Fills in what depends on the scenes and on other settings.
Result<CompileSettings> completed(std::span<const gltf::Scene> scenes, CompileSettings settings) {
    // Some strategies have a tracer of their own. If nothing else traces, it is the only tracer.
    if ((settings.strategies & ~package::pipelineStrategies()) == 0) {
        settings.tracers = package::tracersOf(settings.strategies, settings.tracers);
    }
    GLINT_TRY(settings.emissiveLights, emissiveLightsOf(scenes, settings));
    GLINT_TRY(settings.skyLight, skyLightOf(scenes, settings));
    GLINT_TRY(settings.sizedLights, sizedLightsOf(scenes, settings));
    GLINT_TRY(settings.lightSamples, lightSamplesOf(scenes, settings));
    return settings;
}

// Checks the scenes, then returns the result of `work`. An exception becomes an error.
template <typename Value, typename Work>
Result<Value> guarded(std::span<const gltf::Scene> scenes, const Work& work) {
    if (scenes.empty()) {
        return makeError("scene-missing", "", "there is no scene to compile", "name at least one");
    }
    const std::string where = scenes.front().path;
    try {
        for (const gltf::Scene& scene : scenes) {
            GLINT_TRY_DO(checkScene(scene));
        }
        return work();
    } catch (const std::bad_alloc&) {
        return makeError("out-of-memory", where, "compiling the scene does not fit into memory",
                         "simplify the scene, use fewer --jobs, or a machine with more memory");
    } catch (const std::exception& error) {
        return makeError("internal", where, fmt::format("compiling failed: {}", error.what()),
                         "this is a defect of Glint");
    }
}

}  // namespace

std::vector<std::string> strategyNames(std::uint32_t strategies) {
    std::vector<std::string> names;
    for (const package::Strategy strategy : package::strategies()) {
        if ((strategies & strategy) != 0) {
            names.emplace_back(package::nameOf(strategy));
        }
    }
    return names;
}

std::vector<std::string> tracerNames(std::uint32_t tracers) {
    std::vector<std::string> names;
    for (const package::Tracer tracer : package::kTracers) {
        if ((tracers & tracer) != 0) {
            names.emplace_back(package::nameOf(tracer));
        }
    }
    return names;
}

Result<PackagePlan> planPackage(std::span<const gltf::Scene> scenes, const CompileSettings& settings,
                                std::optional<Plan> made) {
    return guarded<PackagePlan>(scenes, [&]() -> Result<PackagePlan> {
        GLINT_TRY(auto complete, completed(scenes, settings));
        GLINT_TRY(auto prepared, prepare(gltf::SceneList(scenes), complete, std::move(made)));
        std::vector<PlannedModule> modules = planModules(prepared.modules, settings.debugInfo);
        return PackagePlan{std::move(prepared.plan), std::move(modules)};
    });
}

Result<CompiledPackage> compilePackage(std::span<const gltf::Scene> scenes, const CompileSettings& settings,
                                       ModuleCache* cache, std::optional<Plan> made, WarmModules* warm,
                                       const EarlyShowing* showing) {
    return guarded<CompiledPackage>(scenes, [&]() -> Result<CompiledPackage> {
        GLINT_TRY(auto complete, completed(scenes, settings));
        return compile(gltf::SceneList(scenes), complete, cache, std::move(made), warm, showing);
    });
}

}  // namespace glint::compiler

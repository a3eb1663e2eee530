#include "emit/compile.h"

#include "base/clock.h"
#include "base/parallel.h"
#include "emit/context.h"
#include "emit/glsl/passes.h"
#include "emit/material_code.h"
#include "emit/module_files.h"
#include "emit/modules.h"
#include "emit/package/header.h"
#include "emit/package/manifest.h"
#include "emit/package/tables.h"
#include "gltf/scene_list.h"
#include "resolve/resolve.h"
#include "spirv/compiler.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <iterator>
#include <new>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::compiler {

// --- Early packages ---

namespace {

using Names = std::set<std::string, std::less<>>;

bool includes(std::string_view text, std::string_view name) {
    return text.find("#include \"" + std::string(name) + "\"") != std::string_view::npos;
}

// Returns the names of the packs' files that differ, or no value if files came or went.
std::optional<Names> differentFiles(const materials::MaterialModel& before,
                                    const materials::MaterialModel& after) {
    if (before.sources.size() != after.sources.size()) {
        return std::nullopt;
    }
    Names names;
    for (std::size_t i = 0; i < after.sources.size(); ++i) {
        if (before.sources[i].name != after.sources[i].name) {
            return std::nullopt;
        }
        if (before.sources[i].text != after.sources[i].text) {
            names.insert(after.sources[i].name);
        }
    }
    return names;
}

// Adds the files that include one of `names`, directly or not.
void addIncluding(const materials::MaterialModel& model, Names& names) {
    std::size_t known = 0;
    while (known != names.size()) {
        known = names.size();
        for (const materials::ModelSource& source : model.sources) {
            if (std::ranges::any_of(names,
                                    [&](const std::string& name) { return includes(source.text, name); })) {
                names.insert(source.name);
            }
        }
    }
}

}  // namespace

materials::FeatureMask editedFeatures(const materials::MaterialModel& before,
                                      const materials::MaterialModel& after) {
    const std::optional<Names> different = differentFiles(before, after);
    if (!different) {
        return 0;
    }
    materials::FeatureMask edited = 0;
    for (const std::string& name : *different) {
        // Each file on its own: one that no feature of a draft reads is a reason for the whole package.
        Names reading{name};
        addIncluding(after, reading);
        materials::FeatureMask ofFile = 0;
        for (const materials::FeatureCode& code : after.code) {
            const auto reads = [&](const std::string& file) { return reading.contains(file); };
            if (std::ranges::any_of(std::array{code.bsdf, code.layer, code.diffuse, code.opacity}, reads)) {
                return 0;
            }
            const bool shown =
                std::ranges::any_of(std::array{code.coordinates, code.surface, code.emission}, reads);
            if (shown && code.feature < 0) {
                return 0;
            }
            ofFile |= shown ? after.features[static_cast<std::size_t>(code.feature)].mask() : 0;
        }
        if (ofFile == 0) {
            return 0;
        }
        edited |= ofFile;
    }
    return edited;
}

Result<std::optional<CompiledPackage>> makeEarlyPackage(const gltf::SceneList& scenes, const Plan& plan,
                                                        const SourceSet& sources,
                                                        const CompileSettings& settings,
                                                        const CompiledPackage& before, WarmModules* warm) {
    using Early = std::optional<CompiledPackage>;
    const base::Clock::time_point start = base::Clock::now();
    if (settings.passes != package::Passes::Frame) {
        return Early();
    }
    const materials::FeatureMask edited =
        editedFeatures(*before.plan.model, *plan.model) & (plan.primaryAlways | plan.primarySometimes);
    const auto isTables = [](const PackageFile& file) { return file.name == package::kTablesFile; };
    const auto tables = std::ranges::find_if(before.files, isTables);
    if (edited == 0 || tables == before.files.end() ||
        makeTables(scenes, plan, before.modules, settings) != tables->bytes) {
        return Early();
    }
    GLINT_TRY(auto source, makeEditSource(scenes, plan, sources, settings, edited, warm));
    const base::Clock::time_point planned = base::Clock::now();
    std::vector<ModuleSource> only;
    only.push_back(std::move(source));
    GLINT_TRY(auto compiled, compileModules(std::move(only), 1, settings.debugInfo, nullptr, warm));
    const base::Clock::time_point haveSpirv = base::Clock::now();
    CompiledPackage early;
    early.plan = plan;
    for (const CompiledModule& module : before.modules) {
        CompiledModule& copy = early.modules.emplace_back();
        copy.key = module.key;
        copy.name = module.name;
        copy.file = module.file;
        copy.statistics = module.statistics;
        copy.hash = module.hash;
    }
    CompiledModule& edit = compiled.front();
    const auto place = std::ranges::lower_bound(early.modules, edit.key, {}, &CompiledModule::key);
    early.modules.insert(place, edit);
    for (const PackageFile& file : before.files) {
        if (!isTables(file) && file.name != package::kManifestFile) {
            early.files.push_back(file);
        }
    }
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(edit.spirv.data());
    early.files.push_back({edit.file, {bytes, bytes + edit.spirv.size() * sizeof(std::uint32_t)}});
    early.files.push_back({package::kTablesFile, makeTables(scenes, plan, early.modules, settings)});
    early.uniqueSpirv = before.uniqueSpirv + 1;
    early.spirvBytes = before.spirvBytes + edit.statistics.bytes;
    std::ranges::sort(early.files, {}, &PackageFile::name);
    const std::string manifest = makeManifest(scenes, early, settings);
    early.files.push_back({package::kManifestFile, {manifest.begin(), manifest.end()}});
    std::ranges::sort(early.files, {}, &PackageFile::name);
    early.planMs = base::millisecondsBetween(start, planned);
    early.compileMs = base::millisecondsBetween(planned, haveSpirv);
    early.tablesMs = base::millisecondsSince(haveSpirv);
    return Early(std::move(early));
}

// --- Whole packages ---

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

// The results of all steps before SPIR-V.
struct Prepared {
    SourceSet sources;
    std::vector<ModuleSource> modules;
    bool shownEarly = false;
    double earlyMs = 0.0;  // that the early package took
};

// Returns whether an early package is shown. An error of it is not reported: the whole package has the same
// GLSL. `planMs` is how long planning took so far.
bool showEarly(const Build& build, const SourceSet& sources, const EarlyShowing& showing, double planMs,
               WarmModules* warm) {
    Result<std::optional<CompiledPackage>> early =
        makeEarlyPackage(*build.scenes, build.plan, sources, build.settings.compile, *showing.before, warm);
    if (!early || !*early) {
        return false;
    }
    (*early)->planMs += planMs;
    return showing.publish(**early);
}

Result<Prepared> makeGlsl(const Build& build, WarmModules* warm = nullptr,
                          const EarlyShowing* showing = nullptr) {
    const base::Clock::time_point start = base::Clock::now();
    const gltf::SceneList& scenes = *build.scenes;
    const CompileSettings& settings = build.settings.compile;
    if (build.excess) {
        return makeError("max-shaders", scenes.path(), *build.excess);
    }
    GLINT_TRY(auto sources, makeSourceSet(scenes, build.plan, settings));
    const base::Clock::time_point planned = base::Clock::now();
    const bool shown =
        showing != nullptr && showEarly(build, sources, *showing,
                                        build.milliseconds + base::millisecondsBetween(start, planned), warm);
    const double earlyMs = base::millisecondsSince(planned);
    const auto makeSources = [&] { return makeModuleSources(scenes, build.plan, sources, settings, warm); };
    GLINT_TRY(auto modules, shown ? base::runBehind(makeSources) : makeSources());
    return Prepared{std::move(sources), std::move(modules), shown, earlyMs};
}

Result<CompiledPackage> compile(const Build& build, ModuleCache* cache, WarmModules* warm,
                                const EarlyShowing* showing) {
    const base::Clock::time_point start = base::Clock::now();
    const gltf::SceneList& scenes = *build.scenes;
    const CompileSettings& settings = build.settings.compile;
    GLINT_TRY(auto prepared, makeGlsl(build, warm, showing));
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
        return explainGlslError(compiled.error(), *build.plan.model, settings.host);
    }
    const base::Clock::time_point haveSpirv = base::Clock::now();
    CompiledPackage package;
    package.plan = build.plan;
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
    package.planMs = build.milliseconds + base::millisecondsBetween(start, planned) - prepared.earlyMs;
    package.earlyMs = prepared.shownEarly ? prepared.earlyMs : 0.0;
    package.compileMs = base::millisecondsBetween(planned, haveSpirv);
    package.tablesMs = base::millisecondsSince(haveSpirv);
    return package;
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

Result<PackagePlan> planPackage(const Build& build) {
    return guarded<PackagePlan>(build.scenes->scenes(), [&]() -> Result<PackagePlan> {
        GLINT_TRY(const auto prepared, makeGlsl(build));
        return PackagePlan{build.plan, planModules(prepared.modules, build.settings.compile.debugInfo)};
    });
}

Result<PackagePlan> planPackage(std::span<const gltf::Scene> scenes, const CompileSettings& settings) {
    return guarded<PackagePlan>(scenes, [&]() -> Result<PackagePlan> {
        GLINT_TRY(const auto build, resolve(scenes, settings));
        return planPackage(build);
    });
}

Result<CompiledPackage> compilePackage(const Build& build, ModuleCache* cache, WarmModules* warm,
                                       const EarlyShowing* showing) {
    return guarded<CompiledPackage>(build.scenes->scenes(),
                                    [&] { return compile(build, cache, warm, showing); });
}

Result<CompiledPackage> compilePackage(std::span<const gltf::Scene> scenes, const CompileSettings& settings,
                                       ModuleCache* cache) {
    return guarded<CompiledPackage>(scenes, [&]() -> Result<CompiledPackage> {
        GLINT_TRY(const auto build, resolve(scenes, settings));
        return compilePackage(build, cache);
    });
}

}  // namespace glint::compiler

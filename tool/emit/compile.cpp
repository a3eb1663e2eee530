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
#include <cstdint>
#include <iterator>
#include <new>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::compiler {

namespace {

base::Bytes toBytes(std::string_view text) {
    return {text.begin(), text.end()};
}

base::SharedArray<std::uint8_t> bytesOf(const base::SharedArray<std::uint32_t>& words) {
    return {words.owner(),
            {reinterpret_cast<const std::uint8_t*>(words.data()), words.size() * sizeof(std::uint32_t)}};
}

// Adds the modules' files. Modules with equal SPIR-V share one file. With `emitGlsl` their GLSL must have
// been made.
void addModuleFiles(CompiledPackage& package, const std::string& source, bool emitGlsl) {
    std::set<std::string_view> written;
    for (const CompiledModule& module : package.modules) {
        if (written.insert(module.file).second) {
            package.files.push_back({module.file, bytesOf(module.spirv), module.hash});
            package.spirvBytes += module.statistics.bytes;
            ++package.uniqueSpirv;
        }
        if (emitGlsl) {
            const std::string header = fmt::format("// Made by glint {} from {}. Do not edit.\n",
                                                   toolVersion(), commentText(source));
            package.files.push_back(
                {"glsl/" + module.name, toBytes(makeReadable(module.glsl->made(), header))});
        }
    }
}

ShaderCompileOptions shaderOptions(const CompileSettings& settings) {
    return {.debugInfo = settings.debugInfo, .optimize = settings.optimize};
}

// The results of all steps before SPIR-V.
struct Prepared {
    std::shared_ptr<const SourceSet> sources;
    std::vector<ModuleSource> modules;
};

Result<Prepared> makeGlsl(const Build& build, const KnownModules& known) {
    const gltf::SceneList& scenes = *build.scenes;
    const CompileSettings& settings = build.settings.compile;
    if (build.excess) {
        return makeError("max-shaders", scenes.path(), *build.excess);
    }
    GLINT_TRY(auto made, makeSourceSet(scenes, build.plan, settings));
    const auto sources = std::make_shared<const SourceSet>(std::move(made));
    GLINT_TRY(auto modules, makeModuleSources(scenes, build.plan, sources, settings, known));
    return Prepared{sources, std::move(modules)};
}

Result<CompiledPackage> compile(const Build& build, ModuleCache* cache, WarmModules* warm) {
    const base::Clock::time_point start = base::Clock::now();
    const gltf::SceneList& scenes = *build.scenes;
    const CompileSettings& settings = build.settings.compile;
    const ShaderCompileOptions options = shaderOptions(settings);
    const bool makesAll = settings.emitGlsl || settings.debugInfo || !settings.modules.empty();
    GLINT_TRY(auto prepared, makeGlsl(build, {cache, warm, makesAll}));
    const base::Clock::time_point planned = base::Clock::now();
    Result<std::vector<CompiledModule>> compiled = std::vector<CompiledModule>();
    Result<std::string> header = std::string();
    base::runParallel(settings.emitHeader ? 2 : 1, settings.jobs, [&](std::size_t i) {
        if (i == 1) {
            header = makeHeader(scenes, build.plan, *prepared.sources, settings.plan);
        } else if (settings.modules.empty()) {
            compiled = compileModules(std::move(prepared.modules), settings.jobs, options, cache, warm,
                                      settings.newShaders, settings.progress);
        } else {
            compiled = takeModules(std::move(prepared.modules), options, settings.modules);
        }
        return true;
    });
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
        GLINT_TRY(const auto text, std::move(header));
        package.files.push_back({package::kHeaderFile, toBytes(text)});
    }
    if (settings.emitLibrary || settings.emitLinkable) {
        GLINT_TRY(auto library, makeLibrary(scenes, package.plan, settings, cache));
        std::ranges::move(library, std::back_inserter(package.files));
    }
    std::ranges::sort(package.files, {}, &PackageFile::name);
    package.files.push_back({package::kManifestFile, toBytes(makeManifest(scenes, package, settings))});
    std::ranges::sort(package.files, {}, &PackageFile::name);
    package.planMs = build.milliseconds + base::millisecondsBetween(start, planned);
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
        GLINT_TRY(const auto prepared, makeGlsl(build, {}));
        return PackagePlan{build.plan, planModules(prepared.modules, shaderOptions(build.settings.compile))};
    });
}

Result<PackagePlan> planPackage(std::span<const gltf::Scene> scenes, const CompileSettings& settings) {
    return guarded<PackagePlan>(scenes, [&]() -> Result<PackagePlan> {
        GLINT_TRY(const auto build, resolve(scenes, settings));
        return planPackage(build);
    });
}

Result<CompiledPackage> compilePackage(const Build& build, ModuleCache* cache, WarmModules* warm) {
    return guarded<CompiledPackage>(build.scenes->scenes(), [&] { return compile(build, cache, warm); });
}

Result<CompiledPackage> compilePackage(std::span<const gltf::Scene> scenes, const CompileSettings& settings,
                                       ModuleCache* cache) {
    return guarded<CompiledPackage>(scenes, [&]() -> Result<CompiledPackage> {
        GLINT_TRY(const auto build, resolve(scenes, settings));
        return compilePackage(build, cache);
    });
}

}  // namespace glint::compiler

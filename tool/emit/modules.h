// Decides which shader modules a package has, makes their GLSL and, in parallel, their SPIR-V, or takes
// modules that were compiled before.
#pragma once

#include "emit/package/compiled_package.h"
#include "emit/source_set.h"
#include "emit/warm_modules.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"
#include "settings/settings.h"
#include "spirv/compiler.h"

#include <glint/result.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

namespace glint::compiler {

// Results of earlier runs and processes, by which modules are found.
struct KnownModules {
    const ModuleCache* cache = nullptr;  // may be null
    WarmModules* warm = nullptr;         // may be null
    bool makesAll = true;                // also the GLSL of texts whose hash is known
};

// Returns the modules that the settings call for, in order of their keys. Has the errors of renderTemplate()
// and flatten().
Result<std::vector<ModuleSource>> makeModuleSources(const gltf::SceneList& scenes, const Plan& plan,
                                                    const std::shared_ptr<const SourceSet>& sources,
                                                    const CompileSettings& settings,
                                                    const KnownModules& known = {});

// --- SPIR-V ---

// Compiles on `jobs` threads (0: one for each core). Equal texts are compiled once, those of parts too, and
// texts that `cache` or `warm` has are not compiled; both may be null. Neither the result nor the reported
// error depends on `jobs`: if there are several errors, it is that of the first module. Modules with equal
// SPIR-V get the same `file`, that of the first of them. `newShaders` and `progress` are those of
// CompileSettings.
Result<std::vector<CompiledModule>> compileModules(
    std::vector<ModuleSource> sources, int jobs, const ShaderCompileOptions& options,
    ModuleCache* cache = nullptr, WarmModules* warm = nullptr, NewShaders newShaders = NewShaders::Optimized,
    const std::function<void(std::size_t, std::size_t)>& progress = {});

// Takes every module from `folder`, where `glint compile-module` left them. Errors are those of
// readCompiledModule(); if there are several, that of the first module is reported.
Result<std::vector<CompiledModule>> takeModules(std::vector<ModuleSource> sources,
                                                const ShaderCompileOptions& options,
                                                const std::filesystem::path& folder);

}  // namespace glint::compiler

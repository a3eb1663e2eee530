// Shader modules from GLSL to SPIR-V, in parallel, or from where they were compiled before.
#pragma once

#include "cache/module_cache.h"
#include "emit/compile.h"
#include "emit/modules.h"
#include "spirv/compiler.h"

#include <filesystem>
#include <string>
#include <vector>

namespace glint {

// compileShader() and measureSpirv().
Result<CachedModule> compileMeasured(const ShaderSource& source, const ShaderCompileOptions& options);

// Another text for every compiler that may give other words.
std::string moduleCompiler();

// Compiles on `jobs` threads (0: one a core), equal texts once, and nothing that `cache` has (null: there is
// none). The result, and which error is reported, do not depend on `jobs`: of several, that of the first
// module. Modules of equal SPIR-V get the same `file`, that of the first.
Result<std::vector<CompiledModule>> compileModules(std::vector<ModuleSource> sources, int jobs,
                                                   bool debugInfo, ModuleCache* cache = nullptr);

// Takes every module from `folder`, where `glint compile-module` left them; see readCompiledModule() for
// errors, of which that of the first module is reported.
Result<std::vector<CompiledModule>> takeModules(std::vector<ModuleSource> sources, bool debugInfo,
                                                const std::filesystem::path& folder);

}  // namespace glint

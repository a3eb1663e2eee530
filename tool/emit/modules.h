// The shader modules of a package: which there are, and compiling them in parallel.
#pragma once

#include "emit/compile.h"
#include "emit/sources.h"
#include "spirv/compiler.h"

#include <string>
#include <vector>

namespace glint {

// A module before it is compiled.
struct ModuleSource {
    package::ModuleKey key;
    ShaderStage stage = ShaderStage::Compute;
    std::string name;                           // "uber.comp"
    std::string glsl;                           // flattened, without what nothing uses
    std::vector<std::string> functionsApart{};  // see ShaderSource
};

package::PackageShape shapeOf(const Plan& plan, const CompileSettings& settings);

// Those that the settings call for, in order of their keys. Errors as renderTemplate() and
// flatten().
Result<std::vector<ModuleSource>> makeModuleSources(const SceneList& scenes, const Plan& plan,
                                                    const SourceSet& sources,
                                                    const CompileSettings& settings);

// Compiles on `jobs` threads (0: one a core), equal texts once, and nothing that `cache` has (null: there is
// none). The result, and which error is reported, do not depend on `jobs`: of several, that of the first
// module. Modules of equal SPIR-V get the same `file`, that of the first.
Result<std::vector<CompiledModule>> compileModules(std::vector<ModuleSource> sources, int jobs,
                                                   bool debugInfo, ModuleCache* cache = nullptr);

}  // namespace glint

// The shader modules of a package: which there are, and their GLSL.
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

package::PackageShape shapeOf(const SceneList& scenes, const Plan& plan, const CompileSettings& settings);

// Those that the settings call for, in order of their keys. Errors as renderTemplate() and
// flatten().
Result<std::vector<ModuleSource>> makeModuleSources(const SceneList& scenes, const Plan& plan,
                                                    const SourceSet& sources,
                                                    const CompileSettings& settings);

}  // namespace glint

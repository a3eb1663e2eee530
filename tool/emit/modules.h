// Decides which shader modules a package has, and makes their GLSL.
#pragma once

#include "emit/compile.h"
#include "emit/glsl/unit.h"
#include "emit/sources.h"
#include "emit/warm_modules.h"
#include "spirv/compiler.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glint::compiler {

// A module before it is compiled.
struct ModuleSource {
    package::ModuleKey key;
    ShaderStage stage = ShaderStage::Compute;
    std::string name;                                // "uber.comp"
    GlslUnit glsl;                                   // without unused functions, constants and macros
    std::vector<std::string> functionsApart{};       // as in ShaderSource
    std::shared_ptr<const PreparedGlsl> prepared{};  // the same GLSL, if a package has made it
    // Not empty if the module is compiled in parts, the one with the entry point first: see compilePart().
    // They make what `glsl` says.
    std::vector<std::shared_ptr<const ModuleSource>> parts{};
    std::optional<LinkNames> link{};  // of a part
};

package::PackageShape shapeOf(const gltf::SceneList& scenes, const Plan& plan,
                              const CompileSettings& settings);

// Returns the modules that the settings call for, in order of their keys. `warm` may be null. Has the errors
// of renderTemplate() and flatten().
Result<std::vector<ModuleSource>> makeModuleSources(const gltf::SceneList& scenes, const Plan& plan,
                                                    const SourceSet& sources, const CompileSettings& settings,
                                                    WarmModules* warm = nullptr);

// Returns the module of an early package that shows `edited` features. Has the errors of makeModuleSources().
Result<ModuleSource> makeEditSource(const gltf::SceneList& scenes, const Plan& plan, const SourceSet& sources,
                                    const CompileSettings& settings, materials::FeatureMask edited,
                                    WarmModules* warm = nullptr);

}  // namespace glint::compiler

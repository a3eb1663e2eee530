// Shader modules between templates and SPIR-V.
#pragma once

#include "emit/glsl/unit.h"
#include "spirv/compiler.h"

#include <glint/package_modules.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glint::compiler {

struct PreparedGlsl;

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

}  // namespace glint::compiler

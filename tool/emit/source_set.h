// The GLSL of modules: files by the names under which shaders include them, and modules made of these.
#pragma once

#include "emit/glsl/passes.h"
#include "emit/glsl/text.h"
#include "spirv/compiler.h"

#include <glint/internal/package_modules.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

class SourceSet {
public:
    void add(std::string name, std::string text);
    // Returns the file's text, which is valid as long as the set.
    std::optional<std::string_view> find(std::string_view name) const;
    SourceLookup lookup() const;

private:
    std::map<std::string, std::string, std::less<>> files_;
};

// --- Shader modules between templates and SPIR-V ---

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

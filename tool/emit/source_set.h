// The GLSL of modules: files by the names under which shaders include them, and modules made of these.
#pragma once

#include "emit/glsl/passes.h"
#include "emit/glsl/text.h"
#include "spirv/compiler.h"

#include <glint/internal/package_modules.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace glint::compiler {

class SourceSet {
public:
    void add(std::string name, std::string text);
    // Returns the file's text, which is valid as long as the set.
    std::optional<std::string_view> find(std::string_view name) const;
    // Returns a number that differs between texts of the file, or nothing if there is no such file.
    std::optional<std::uint64_t> markOf(std::string_view name) const;
    SourceLookup lookup() const;
    // Returns a number that differs between sets.
    std::uint64_t mark() const {
        return mark_;
    }
    // Returns the names of all files with their marks, ascending.
    std::vector<std::pair<std::string, std::uint64_t>> marks() const;

private:
    struct File {
        std::string text;
        std::uint64_t mark = 0;
    };
    struct NameHash : std::hash<std::string_view> {
        using is_transparent = void;
    };
    std::unordered_map<std::string, File, NameHash, std::equal_to<>> files_;
    std::uint64_t mark_ = 0;
};

// Identifies a text of a module (makeModuleText()), or a part of one.
using TextHash = std::pair<std::uint64_t, std::uint64_t>;
TextHash hashOfText(std::string_view text);

// The GLSL of a module after flattening and pruning.
struct PreparedGlsl {
    PreparedGlsl(GlslUnit prepared, std::string essentialOfIt)
        : unit(std::move(prepared)), essential(std::move(essentialOfIt)), hash(hashOfText(essential)) {}

    GlslUnit unit;          // without unused functions, constants and macros
    std::string essential;  // essentialText() of it
    TextHash hash;          // of `essential`
};

// --- Shader modules between templates and SPIR-V ---

// A module before it is compiled.
struct ModuleSource {
    package::ModuleKey key;
    ShaderStage stage = ShaderStage::Compute;
    std::string name;  // "uber.comp"
    std::shared_ptr<const PreparedGlsl> glsl{};
    std::vector<std::string> functionsApart{};  // as in ShaderSource
    // Not empty if the module is compiled in parts, the one with the entry point first: see compilePart().
    // They make what `glsl` says.
    std::vector<std::shared_ptr<const ModuleSource>> parts{};
    std::optional<LinkNames> link{};  // of a part
};

}  // namespace glint::compiler

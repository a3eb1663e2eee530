// The GLSL of modules: files by the names under which shaders include them, and modules made of these.
#pragma once

#include "cache/module_cache.h"
#include "emit/glsl/passes.h"
#include "emit/glsl/text.h"
#include "spirv/compiler.h"

#include <glint/internal/package_modules.h>
#include <glint/result.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace glint::compiler {

// Returns the number under which a source is known (SourceSet::markOf()): a file, or an item of one.
std::uint64_t sourceNumber(std::string_view file, std::string_view item = {});

class SourceSet {
public:
    // The words of items, by their names: macros, constants and functions. Those of "" have none.
    using Items = std::unordered_map<std::string_view, std::vector<std::string_view>>;

    SourceSet() = default;
    SourceSet(const SourceSet&) = delete;
    SourceSet& operator=(const SourceSet&) = delete;
    SourceSet(SourceSet&&) = default;
    SourceSet& operator=(SourceSet&&) = default;

    void add(std::string name, std::string text);
    // Adds a file whose items are sources of their own: a module depends on those that it uses, and not on
    // the others.
    void addItems(std::string name, std::string text);
    // Returns the file's text, which is valid as long as the set.
    std::optional<std::string_view> find(std::string_view name) const;
    // Returns null unless addItems() has added the file.
    const Items* itemsOf(std::string_view name) const;
    // Returns a number that differs between texts of a source; nothing if there is none with this
    // sourceNumber().
    std::optional<std::uint64_t> markOf(std::uint64_t source) const;
    SourceLookup lookup() const;

private:
    struct File {
        std::unique_ptr<const std::string> text;  // stays where it is when the set moves
        std::optional<Items> items{};
    };
    struct NameHash : std::hash<std::string_view> {
        using is_transparent = void;
    };
    File& addFile(std::string name, std::string text);

    std::unordered_map<std::string, File, NameHash, std::equal_to<>> files_;
    std::unordered_map<std::uint64_t, std::uint64_t> marks_;
};

// The GLSL of a module after flattening and pruning. Whoever knows the hash of its text need not make it.
class ModuleGlsl {
public:
    using Make = std::function<Result<GlslUnit>()>;

    explicit ModuleGlsl(GlslUnit unit);
    // `make` makes the text with this hash when somebody asks for it.
    ModuleGlsl(const TextHash& hash, Make make) : hash_(hash), make_(std::move(make)) {}

    // Returns the hash of essentialText().
    const TextHash& hash() const {
        return hash_;
    }
    // Thread-safe. Has the errors of making it.
    Result<const GlslUnit*> unit() const;
    // Requires that the unit has been made.
    const GlslUnit& made() const {
        return *unit_;
    }

private:
    TextHash hash_;
    Make make_;
    mutable std::mutex making_;
    mutable std::optional<GlslUnit> unit_;
};

// --- Shader modules between templates and SPIR-V ---

// A module before it is compiled.
struct ModuleSource {
    package::ModuleKey key;
    ShaderStage stage = ShaderStage::Compute;
    std::string name;  // "uber.comp"
    std::shared_ptr<const ModuleGlsl> glsl{};
    std::vector<std::string> functionsApart{};  // as in ShaderSource
    // Not empty if the module is compiled in parts, the one with the entry point first: see compilePart().
    // They make what `glsl` says.
    std::vector<std::shared_ptr<const ModuleSource>> parts{};
    std::optional<LinkNames> link{};  // of a part
};

}  // namespace glint::compiler

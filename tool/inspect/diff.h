// The differences between two packages.
#pragma once

#include "spirv/statistics.h"

#include <glint/internal/package_modules.h>
#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace glint::inspect {

struct DiffModule {
    std::string file;
    std::uint64_t hash = 0;
    compiler::SpirvStatistics statistics;
};

struct DiffCase {
    std::string name;
    std::set<std::vector<std::string>> keys;             // each the names of its features
    std::map<package::ModuleKey, DiffModule> modules{};  // with index 0
};

// Identifies a material, whose index may change from package to package.
struct DiffMaterial {
    std::string scene;
    std::string name;
    int sameNamed = 0;  // materials of that scene and name with lower indices

    // The compiler generates a comparison with 0 here. NOLINTNEXTLINE(modernize-use-nullptr)
    friend auto operator<=>(const DiffMaterial&, const DiffMaterial&) = default;
};

struct DiffPackage {
    std::vector<std::pair<std::string, std::string>> settings;  // name, value
    std::vector<std::string> scenes;
    std::map<int, DiffCase> cases;                    // by shader ID, without retired ones
    std::map<package::ModuleKey, DiffModule> passes;  // every other module
    std::map<DiffMaterial, std::set<int>> materials;  // of those that are in use: their shader IDs
    std::vector<std::pair<std::string, std::uint64_t>> totals;
    std::string tables;  // hash of tables.bin
};

// Has the errors of Package::load() and readFile(), and "manifest-format".
Result<DiffPackage> readDiffPackage(const std::filesystem::path& folder);

struct SettingChange {
    std::string name;
    std::string before;  // "-" where a package lacks the setting
    std::string after;
};

enum class ShaderChangeKind : std::uint8_t {
    Added,
    Removed,
    Moved,      // another ID
    Renamed,    // the same ID
    Keys,       // the same ID and name, other keys
    Merged,     // several became one
    Split,      // one became several
    Regrouped,  // several became several others
};

// Shaders that have keys in common, directly or through other shaders.
struct ShaderChange {
    ShaderChangeKind kind{};
    std::vector<int> before;  // shader IDs, ascending
    std::vector<int> after;
    std::vector<std::vector<std::string>> keysAdded;
    std::vector<std::vector<std::string>> keysRemoved;
};

// A module of both packages whose SPIR-V differs, or one that only one package has. Modules of cases are
// compared if their cases are.
struct ModuleChange {
    package::ModuleKey key;       // index 0 for those of cases
    std::optional<int> idBefore;  // of cases
    std::optional<int> idAfter;
    const DiffModule* before = nullptr;
    const DiffModule* after = nullptr;
};

struct MaterialChange {
    DiffMaterial material;
    std::vector<int> before;  // shader IDs; empty: it was not in use
    std::vector<int> after;
};

struct TotalChange {
    std::string name;
    std::uint64_t before = 0;
    std::uint64_t after = 0;
};

struct PackageDiff {
    std::vector<SettingChange> settings;
    std::vector<ShaderChange> shaders;
    std::vector<ModuleChange> modules;
    std::vector<MaterialChange> materials;
    std::vector<TotalChange> totals;
    bool tablesDiffer = false;
    // The numbers of things that are equal in both.
    std::size_t sameShaders = 0;
    std::size_t sameModules = 0;
    std::size_t sameMaterials = 0;

    bool isEmpty() const {
        return settings.empty() && shaders.empty() && modules.empty() && materials.empty() && !tablesDiffer;
    }
};

// The result is valid as long as the packages are.
PackageDiff comparePackages(const DiffPackage& before, const DiffPackage& after);

}  // namespace glint::inspect

// The parts of a package that `glint diff` compares: from manifest.json, and from tables.bin and the modules
// as the runtime's loader reads them.
#pragma once

#include "spirv/statistics.h"

#include <glint/package_modules.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace glint {

struct DiffModule {
    std::string file;
    std::uint64_t hash = 0;
    SpirvStatistics statistics;
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

}  // namespace glint

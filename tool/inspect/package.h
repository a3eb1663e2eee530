// The contents of a package: its modules with statistics, its materials, and its manifest.json.
#pragma once

#include "emit/package/manifest.h"
#include "materials/material_model.h"
#include "spirv/statistics.h"

#include <glint/package.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace glint::inspect {

// A manifest, and parts of it by their IDs.
struct Manifest : compiler::Manifest {
    // Names by scene and index, for the materials that have one and that shaders list.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::string> materialNames;
    std::map<std::uint32_t, double> shares;  // of the expected hits, by shader ID
};

// Has the errors of compiler::readManifest().
Result<Manifest> readManifest(const std::filesystem::path& folder);

struct InspectedModule {
    const package::ModuleEntry* entry = nullptr;
    compiler::SpirvStatistics statistics;

    package::ModuleKey key() const {
        return {entry->role, entry->index, entry->tracer};
    }
};

using MaterialPlace = std::pair<std::uint32_t, std::uint32_t>;  // scene, index

struct InspectedPackage {
    const Package& package;
    const Manifest& manifest;
    std::string folder;
    std::vector<InspectedModule> modules;
    std::map<std::uint32_t, std::set<MaterialPlace>> materials;  // by shader ID

    // Returns the number of cases that are not retired.
    std::size_t caseCount() const;
    // Returns the modules of one case.
    std::vector<const InspectedModule*> modulesOf(std::uint32_t shaderId) const;
    std::string materialName(const MaterialPlace& material) const;
    std::string file(const InspectedModule& module) const;
    // Returns an empty text if there is none.
    std::string variantOf(std::uint32_t scene) const;
    // Returns the number of files; modules that share a file count once.
    std::size_t uniqueFiles() const;
    std::uint64_t spirvBytes() const;
};

// `package` and `manifest` must outlive the result. Has the errors of measureSpirv().
Result<InspectedPackage> inspectPackage(const Package& package, const Manifest& manifest, std::string folder);

// A module as assembly.
struct Disassembly {
    const InspectedModule* module = nullptr;
    std::string text;
};

// Disassembles the modules of a shader ID, of a role, of a shader's name or of a file. Error "module-unknown"
// if there is none.
Result<std::vector<Disassembly>> disassembleModules(const InspectedPackage& inspected,
                                                    const std::string& wanted);

}  // namespace glint::inspect

// The facts about a package that glint inspect knows, and their output.
#pragma once

#include "cli/manifest.h"
#include "cli/report.h"
#include "cli/table.h"
#include "spirv/statistics.h"

#include <glint/package.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace glint {

struct InspectedModule {
    const package::ModuleEntry* entry = nullptr;
    SpirvStatistics statistics;

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

Json toJson(const InspectedPackage& inspected);
std::string toText(const InspectedPackage& inspected, Detail detail);

// A module as assembly.
struct Disassembly {
    const InspectedModule* module = nullptr;
    std::string text;
};

// Disassembles the modules of a shader ID, of a role, of a shader's name or of a file. Error "module-unknown"
// if there is none.
Result<std::vector<Disassembly>> disassembleModules(const InspectedPackage& inspected,
                                                    const std::string& wanted);
Json toJson(const InspectedPackage& inspected, const std::vector<Disassembly>& list);
std::string toText(const InspectedPackage& inspected, const std::vector<Disassembly>& list);

}  // namespace glint

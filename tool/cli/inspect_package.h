// What glint inspect knows of a package, and how it says that.
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

    // Those that are not retired.
    std::size_t caseCount() const;
    // The modules of one case.
    std::vector<const InspectedModule*> modulesOf(std::uint32_t shaderId) const;
    std::string materialName(const MaterialPlace& material) const;
    std::string file(const InspectedModule& module) const;
    // Empty: none.
    std::string variantOf(std::uint32_t scene) const;
    // Modules that share a file count once.
    std::size_t uniqueFiles() const;
    std::uint64_t spirvBytes() const;
};

// `package` and `manifest` must outlive the result. Errors of measureSpirv().
Result<InspectedPackage> inspectPackage(const Package& package, const Manifest& manifest, std::string folder);

Json toJson(const InspectedPackage& inspected);
std::string toText(const InspectedPackage& inspected, Detail detail);

// A module as assembly.
struct Disassembly {
    const InspectedModule* module = nullptr;
    std::string text;
};

// Of the modules of a shader ID, or of those of a role, a shader's name or a file. Error "module-unknown"
// where there is none.
Result<std::vector<Disassembly>> disassembleModules(const InspectedPackage& inspected,
                                                    const std::string& wanted);
Json toJson(const InspectedPackage& inspected, const std::vector<Disassembly>& list);
std::string toText(const InspectedPackage& inspected, const std::vector<Disassembly>& list);

}  // namespace glint

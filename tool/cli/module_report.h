// What commands say of shader modules.
#pragma once

#include "cli/report.h"
#include "emit/compile.h"

#include <glint/package_modules.h>

#include <string>

namespace glint {

// bytes, instructions, textureFetches, rayQueries, branches
Json statisticsToJson(const SpirvStatistics& statistics);

// The case's own modules by stage, as in the manifest; empty without a package, and for strategies that have
// none.
Json stagesToJson(const CompiledPackage* package, int shaderId);

// Which of the modules of its role it is; empty where there is only one.
std::string tracerName(const package::ModuleKey& key);    // "ray-query"
std::string orderingName(const package::ModuleKey& key);  // "wave-ballot"

}  // namespace glint

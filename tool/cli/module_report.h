// The output of commands about shader modules.
#pragma once

#include "cli/report.h"
#include "emit/compile.h"

#include <glint/package_modules.h>

#include <string>

namespace glint {

// bytes, instructions, textureFetches, rayQueries, branches
Json statisticsToJson(const SpirvStatistics& statistics);

// Returns the case's own modules by stage, as in the manifest. Empty without a package, and for strategies
// that have none.
Json stagesToJson(const CompiledPackage* package, int shaderId);

// These name which of the modules of its role it is; empty if there is only one.
std::string tracerName(const package::ModuleKey& key);    // "ray-query"
std::string orderingName(const package::ModuleKey& key);  // "wave-ballot"

}  // namespace glint

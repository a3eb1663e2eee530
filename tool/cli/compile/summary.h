// The text that `compile` prints at the end of a run, and again if a run has nothing to do.
#pragma once

#include "cli/console.h"
#include "cli/report.h"
#include "emit/compile.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::cli {

// Moving the Json can't throw here. NOLINTNEXTLINE(bugprone-exception-escape)
struct CompileSummary {
    base::Json json;
    std::vector<std::vector<std::string>> fields;  // name and value; the last is the output
    std::string dropped;                           // text below the fields
    int modules = 0;                               // of the package
};

// The numbers of a package's modules; absent after a dry run.
struct ModuleCounts {
    int compiled = 0;
    int cached = 0;  // or with the text of another
    // These count the parts of the modules that were joined in this run.
    int partsCompiled = 0;
    int partsCached = 0;
};

ModuleCounts countModules(const compiler::CompiledPackage& package);

// Adds `milliseconds`, `modules` and `upToDate`, and prints the summary. The JSON already has places for
// these members.
void tell(const Console& console, CompileSummary summary, const std::optional<ModuleCounts>& modules,
          bool upToDate, double milliseconds);

std::string pack(const CompileSummary& summary);
// Returns nothing if `bytes` is not a summary. Without `withJson` the JSON stays empty; parsing it takes time
// that grows with the scene.
std::optional<CompileSummary> unpackSummary(std::string_view bytes, bool withJson);

}  // namespace glint::cli

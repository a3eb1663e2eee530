// What `compile` tells at the end of a run, and again of a run that had nothing to do.
#pragma once

#include "cli/console.h"
#include "cli/report.h"
#include "emit/compile.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// NOLINTNEXTLINE(bugprone-exception-escape): the move of Json, which throws nothing that can be thrown here.
struct CompileSummary {
    Json json;
    std::vector<std::vector<std::string>> fields;  // name and value; the last is the output
    std::string dropped;                           // text below the fields
    int modules = 0;                               // of the package
};

// Of the modules of a package; absent after a dry run.
struct ModuleCounts {
    int compiled = 0;
    int cached = 0;  // or with the text of another
};

ModuleCounts countModules(const CompiledPackage& package);

// Adds `milliseconds`, `modules` and `upToDate`, and prints. The members have their places in the JSON
// already.
void tell(const Console& console, CompileSummary summary, const std::optional<ModuleCounts>& modules,
          bool upToDate, double milliseconds);

std::string pack(const CompileSummary& summary);
// Nothing where `bytes` is no summary. Without `withJson`, which takes time that grows with the scene, the
// JSON stays empty.
std::optional<CompileSummary> unpackSummary(std::string_view bytes, bool withJson);

}  // namespace glint

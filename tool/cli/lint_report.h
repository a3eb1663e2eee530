// The results of glint lint, as a table and as JSON.
#pragma once

#include "cli/lint_files.h"
#include "cli/lint_malioc.h"
#include "cli/report.h"
#include "cli/table.h"
#include "spirv/lint.h"

#include <optional>
#include <string>
#include <vector>

namespace glint {

struct LintedModule {
    LintFile file;
    std::optional<SpirvLint> lint;  // nothing where the file can't be read
    std::optional<MaliocReport> malioc;
    std::vector<LintFinding> findings;  // all of them: shape, budgets, why it can't be read
};

struct LintedFolder {
    std::string path;
    std::vector<LintFinding> findings;  // of its modules together
};

struct LintReport {
    std::vector<LintedModule> modules;
    std::vector<LintedFolder> folders;
    std::optional<std::filesystem::path> malioc;  // nothing where there is none
    std::size_t count(Severity severity) const;
};

// Returns "file.spv: error: in main (word 214): message; hint [rule]".
Diagnostic toDiagnostic(const LintFinding& finding, const std::string& where);

// Names of modules are shown with Detail::Whole only, because their files are named after them.
std::string toText(const LintReport& report, Detail detail);
// Returns the JSON that docs/lint.md describes.
Json toJson(const LintReport& report);

}  // namespace glint

// Finds the SPIR-V modules that a path stands for, their slow code, and whether they exceed budgets.
#pragma once

#include "spirv/lint.h"

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::inspect {

// The contents of its JSON report ("performance" schema). Members that a version leaves out are absent.
struct MaliocReport {
    std::string core;                         // "Mali-G710"
    std::map<std::string, double> cycles;     // of the longest path, by pipeline
    std::vector<std::string> boundPipelines;  // those that the longest path is bound by
    std::optional<double> longestCycles;      // the largest of `cycles`
    std::optional<std::int64_t> workRegisters;
    std::optional<std::int64_t> occupancy;  // threads, in percent
    std::optional<bool> spills;
    std::optional<std::int64_t> spillBytes;  // of stack, a thread
    std::optional<bool> slowRayTraversal;    // ray queries leave the fast path of the hardware
};

// Returns `program` as given if it contains a slash, else the first executable file of that name in PATH.
// Returns nothing if there is none.
std::optional<std::filesystem::path> findProgram(const std::string& program);

// Error "malioc" if it can't be run, fails (with its message), or prints no report. An empty `core` means the
// program's default.
Result<MaliocReport> runMalioc(const std::filesystem::path& program, const std::string& core,
                               const std::filesystem::path& spirv);
// Error "malioc" if `text` is no report, or if it reports errors.
Result<MaliocReport> parseMalioc(std::string_view text);

struct LintFile {
    std::filesystem::path path;
    std::string name;  // role, or case and stage, as the package's manifest has it; empty without one
};

struct LintFiles {
    bool isFolder = false;
    std::vector<LintFile> files;
};

// A file stands for itself. A package stands for the modules that its manifest names, each file once, in its
// order. Another folder stands for every .spv below it, sorted by name. Errors: "lint-path" (nothing there,
// no module in the folder), "manifest-format", and those of readFile() for the manifest.
Result<LintFiles> findLintFiles(const std::filesystem::path& path);

struct LintedModule {
    LintFile file;
    std::optional<compiler::SpirvLint> lint;  // nothing where the file can't be read
    std::optional<MaliocReport> malioc;
    std::vector<compiler::LintFinding> findings;  // all of them: shape, budgets, why it can't be read
};

struct LintedFolder {
    std::string path;
    std::vector<compiler::LintFinding> findings;  // of its modules together
};

std::size_t countIn(const std::vector<compiler::LintFinding>& findings, Severity severity);

struct LintReport {
    std::vector<LintedModule> modules;
    std::vector<LintedFolder> folders;
    std::optional<std::filesystem::path> malioc;  // nothing where there is none
    std::size_t count(Severity severity) const;
};

// Returns "file.spv: error: in main (word 214): message; hint [rule]".
Diagnostic toDiagnostic(const compiler::LintFinding& finding, const std::string& where);

// The most that a module may have of each; without a value there is no limit.
struct LintBudgets {
    std::optional<std::int64_t> instructions;
    std::optional<std::int64_t> textureFetches;
    std::optional<std::int64_t> rayQueries;
};

// Lints one module. If `malioc` is not empty, compute shaders are also given to that program, for `core`.
// Problems with the file are findings.
LintedModule lintModule(const LintFile& file, const LintBudgets& budgets,
                        const std::optional<std::filesystem::path>& malioc, const std::string& core);

// Judges a folder's modules together: a pipeline with many closest-hit shaders.
std::vector<compiler::LintFinding> judgeTogether(std::span<const LintedModule> modules);

}  // namespace glint::inspect

// Finds the SPIR-V modules that a path stands for.
#pragma once

#include <glint/result.h>

#include <filesystem>
#include <string>
#include <vector>

namespace glint {

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

}  // namespace glint

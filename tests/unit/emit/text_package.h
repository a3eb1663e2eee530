// Packages of a few text files, and what a folder holds: writing looks at nothing else.
#pragma once

#include "emit/compile.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

namespace glint::testing {

// Files by name, and a manifest that lists them.
CompiledPackage makePackage(const std::map<std::string, std::string>& contents);

// Contents of all files below `folder`, by name.
std::map<std::string, std::string> readFolder(const std::filesystem::path& folder);

std::size_t countEntries(const std::filesystem::path& folder);

}  // namespace glint::testing

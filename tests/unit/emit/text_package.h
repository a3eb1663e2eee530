// Packages of a few text files, and the contents of a folder. Writing does not look at the contents.
#pragma once

#include "emit/compile.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

namespace glint::testing {

// Makes a package of files by name, and a manifest that lists them.
compiler::CompiledPackage makePackage(const std::map<std::string, std::string>& contents);

// Returns the contents of all files below `folder`, by name.
std::map<std::string, std::string> readFolder(const std::filesystem::path& folder);

std::size_t countEntries(const std::filesystem::path& folder);

}  // namespace glint::testing

// Replaces files of a folder that must itself stay in place: a working folder, a mount point, or one whose
// parent can't be written.
#pragma once

#include "emit/package/compiled_package.h"

#include <glint/result.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace glint::compiler {

// Removes the files `leaving` (names relative to `folder`) and moves those of `arriving` in. A reader sees
// the earlier tables.bin, none, or the new one with all files that it names. On error "output-write"
// everything is as it was. Files that are not part of a package are never replaced.
Status replaceInPlace(std::span<const PackageFile* const> arriving, const std::vector<std::string>& leaving,
                      const std::filesystem::path& folder);

}  // namespace glint::compiler

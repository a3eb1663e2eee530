// Replacing files of a folder that must stay where it is: a working folder, a mount point, or one whose
// parent can't be written.
#pragma once

#include "emit/compile.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Takes the files `leaving` (names below `folder`) away and brings those of `arriving` in. A reader sees the
// earlier tables.bin, none, or the new one with all that it names. On error "output-write" everything is as
// it was; a file of somebody else's is never replaced.
Status replaceInPlace(std::span<const PackageFile* const> arriving, const std::vector<std::string>& leaving,
                      const std::filesystem::path& folder);

}  // namespace glint

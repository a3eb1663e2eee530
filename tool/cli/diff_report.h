// The text that `glint diff` prints.
#pragma once

#include "cli/diff_compare.h"
#include "cli/report.h"
#include "cli/table.h"

#include <string>

namespace glint {

// The two packages that are compared, and their names.
struct DiffSides {
    std::string nameBefore;  // folders, as given
    std::string nameAfter;
    const DiffPackage& before;
    const DiffPackage& after;
};

// Tables of what differs, and a line that counts what does not.
std::string diffText(const PackageDiff& diff, const DiffSides& sides, Detail detail);
Json diffJson(const PackageDiff& diff, const DiffSides& sides);

}  // namespace glint

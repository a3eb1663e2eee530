// The text that `glint diff` prints.
#pragma once

#include "cli/diff_compare.h"
#include "cli/report.h"

#include <string>

namespace glint {

// The two packages that are compared, and their names.
struct DiffSides {
    std::string nameBefore;  // folders, as given
    std::string nameAfter;
    const DiffPackage& before;
    const DiffPackage& after;
};

// Returns tables of the differences, and a line that counts what is equal.
std::string diffText(const PackageDiff& diff, const DiffSides& sides);
Json diffJson(const PackageDiff& diff, const DiffSides& sides);

}  // namespace glint

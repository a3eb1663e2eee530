// The sources from which the program was built.
#pragma once

#include <string_view>

namespace glint::measure {

// Returns the abbreviated commit, with "-dirty" if files were changed since, or "unknown" for sources without
// a repository.
std::string_view sourceCommit();

}  // namespace glint::measure

// Which sources the program was built from.
#pragma once

#include <string_view>

namespace glint {

// The commit, abbreviated, with "-dirty" where files were changed since; "unknown" for sources without a
// repository.
std::string_view sourceCommit();

}  // namespace glint

// The text of a module for people: as if it had been written by hand for this module alone.
#pragma once

#include "emit/glsl/unit.h"

#include <string>
#include <string_view>

namespace glint::compiler {

// Returns a text that has no branches that its own #defines decide against, no parts that are unused or only
// for C++, and one place for its extensions. It begins with the lines of `header`, each a comment, unless the
// unit already has a header that says what made it. It compiles to the same SPIR-V as long as that holds no
// debug information.
std::string makeReadable(const GlslUnit& unit, std::string_view header);

}  // namespace glint::compiler

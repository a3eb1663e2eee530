// Names that a text shares with whatever includes it.
#pragma once

#include <string>
#include <string_view>

namespace glint::compiler {

// Puts "glint_" before the names that a text without #include and #line declares at its top level: functions,
// macros, constants, structs and blocks. A macro GLINT_A becomes GLINT_LIBRARY_A. Names that begin with glint
// or Glint stay, and so do members.
std::string prefixNames(std::string_view glsl);

}  // namespace glint::compiler

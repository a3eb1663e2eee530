// Removes everything from a module's text that the module does not use.
#pragma once

#include "emit/glsl/unit.h"

#include <string>
#include <string_view>

namespace glint::compiler {

// Returns the unit without the functions, constants and macros that the rest does not reach. Comments right
// above them are dropped too. In doubt an item stays: the text keeps its meaning, and a second call changes
// nothing.
GlslUnit dropUnused(const GlslUnit& unit);

// Returns a unit's text without comments, blank lines and indentation. This alone decides about its SPIR-V if
// that has no debug information.
std::string essentialText(std::string_view glsl);

// --- Names that a text shares with whatever includes it ---

// Puts "glint_" before the names that a text without #include and #line declares at its top level: functions,
// macros, constants, structs and blocks. A macro GLINT_A becomes GLINT_LIBRARY_A. Names that begin with glint
// or Glint stay, and so do members.
std::string prefixNames(std::string_view glsl);

}  // namespace glint::compiler

// Removes everything from a module's text that the module does not use.
#pragma once

#include <string>
#include <string_view>

namespace glint {

// Returns the text, flattened as by flatten(), without the functions, constants and macros that the rest does
// not reach. Comments right above them are dropped too. #line directives are adjusted, so that messages still
// name the real lines. In doubt an item stays: the text keeps its meaning, and a second call changes nothing.
std::string dropUnused(std::string_view glsl);

// Returns the text without comments, blank lines, indentation and #line directives. This alone decides about
// its SPIR-V if that has no debug information.
std::string essentialText(std::string_view glsl);

}  // namespace glint

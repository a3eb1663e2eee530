// Makes a module's text depend on nothing that the module does not use.
#pragma once

#include <string>
#include <string_view>

namespace glint {

// The text, flattened as by flatten(), without the functions, constants and macros that nothing of the rest
// reaches. Comments that stand right above go with them. Place directives follow, so that messages still name
// the real lines. What can't be told apart stays: the text keeps its meaning, and dropping again changes
// nothing.
std::string dropUnused(std::string_view glsl);

// The text without comments, blank lines, indentation and place directives: what decides about its SPIR-V
// where that has no debug information.
std::string essentialText(std::string_view glsl);

}  // namespace glint

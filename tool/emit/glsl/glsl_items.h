// Splits flattened GLSL into the items at its top level.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace glint {

enum class GlslItemKind : std::uint8_t {
    Blank,    // one line
    Comment,  // whole lines
    Macro,    // a #define with its continued lines
    Code      // declarations and all other directives; whole lines
};

struct GlslItem {
    GlslItemKind kind = GlslItemKind::Code;
    std::string_view text;  // whole lines, including the line breaks
    // The name of a macro, a function's definition or a constant, which can be dropped if nothing uses it. An
    // item without a name stays.
    std::string_view name;
    std::vector<std::string_view> words;   // identifiers
    std::vector<std::string_view> pasted;  // in a macro: the words that ## makes names of; "" means any name
    // The place of the first line and of the line after the last. Files are empty before the first #line.
    std::string_view file;
    int line = 0;
    std::string_view endFile;
    int endLine = 0;
};

// Returns all lines in order, except the #line directives. Views point into `glsl`. An item that is not
// clearly one definition (several on a line, a prototype, directives that cross its borders) has no name.
std::vector<GlslItem> splitGlsl(std::string_view glsl);

}  // namespace glint

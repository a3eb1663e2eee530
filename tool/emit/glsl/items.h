// Splits GLSL into the items at its top level.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace glint::compiler {

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
    std::size_t firstLine = 0;             // counts the lines of the whole text, from 0
    std::size_t lineCount = 0;
};

// Returns all lines in order. Views point into `glsl`. An item that is not clearly one definition (several on
// a line, a prototype, directives that cross its borders) has no name.
std::vector<GlslItem> splitGlsl(std::string_view glsl);

}  // namespace glint::compiler

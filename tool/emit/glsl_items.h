// Flattened GLSL as a list of what stands at its top level.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace glint {

enum class GlslItemKind : std::uint8_t {
    Blank,    // one line
    Comment,  // whole lines
    Macro,    // #define with its continued lines
    Code      // declarations and every other directive; whole lines
};

struct GlslItem {
    GlslItemKind kind = GlslItemKind::Code;
    std::string_view text;  // whole lines, with the line breaks
    // Of a macro, a function's definition or a constant: what could go if nothing used it. Empty: stays.
    std::string_view name;
    std::vector<std::string_view> words;   // identifiers
    std::vector<std::string_view> pasted;  // of a macro: what ## makes names of; "": any name
    // The place of the first line, and of the line after the last; files are empty before the first #line.
    std::string_view file;
    int line = 0;
    std::string_view endFile;
    int endLine = 0;
};

// Every line but the #line directives, in order. Views point into `glsl`. What is no definition beyond doubt
// (several on a line, a prototype, directives that cross its borders) has no name.
std::vector<GlslItem> splitGlsl(std::string_view glsl);

}  // namespace glint

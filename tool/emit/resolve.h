// The second half of a preprocessor: what the text itself decides.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace glint {

// A line of GLSL, and the file that it is from.
struct GlslLine {
    std::string text;
    std::string file;  // "hit/list.glsl", as an #include names it
};

// The lines of a flattened text, whose #line directives become the lines' files; without #version and the
// extension for those directives.
std::vector<GlslLine> linesOf(std::string_view flattened);

// Drops the branches of conditionals that the #defines before them decide against, and the directives of
// those that they decide; others stay. Conditions that are decided are NAME, NAME == number, NAME != number,
// and whether a name is defined, for names that begin with "GLINT_".
std::vector<GlslLine> resolveConditionals(std::vector<GlslLine> lines);

// Replaces the macros that `file` defines, each on one line, by what they stand for, and drops what is empty
// then.
std::vector<GlslLine> expandMacros(std::vector<GlslLine> lines, std::string_view file);

}  // namespace glint

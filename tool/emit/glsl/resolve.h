// The second half of a preprocessor: it resolves what the text itself decides.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace glint {

// A line of GLSL and the file that it comes from.
struct GlslLine {
    std::string text;
    std::string file;  // "hit/list.glsl", as an #include names it
};

// Splits a flattened text into lines. Its #line directives become the lines' files; #version and the
// extension for those directives are dropped.
std::vector<GlslLine> linesOf(std::string_view flattened);

// Drops the branches of conditionals that earlier #defines decide against, and the directives of decided
// conditionals. Undecided ones stay. It decides these conditions: NAME, NAME == number, NAME != number, and
// whether a name is defined, for names that begin with "GLINT_".
std::vector<GlslLine> resolveConditionals(std::vector<GlslLine> lines);

// Replaces the macros that `file` defines, each on one line, by their bodies. Lines that become empty are
// dropped.
std::vector<GlslLine> expandMacros(std::vector<GlslLine> lines, std::string_view file);

}  // namespace glint

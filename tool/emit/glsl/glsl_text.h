// Lines and directives of GLSL text.
#pragma once

#include <string_view>
#include <vector>

namespace glint {

// Returns `text` without blanks at both ends.
std::string_view trim(std::string_view text);

// Returns the lines without their line breaks, which may be of either kind.
std::vector<std::string_view> splitLines(std::string_view text);

// A directive: "#ifdef X // why" is {"ifdef", "X"}. A line without a directive has an empty word.
struct Directive {
    std::string_view word;
    std::string_view argument;
};
Directive parseDirective(std::string_view line);

// Returns the identifiers of a line in order, without those in comments.
std::vector<std::string_view> identifiersOf(std::string_view line);

}  // namespace glint

// Lines and directives of GLSL text.
#pragma once

#include <string_view>
#include <vector>

namespace glint {

// Without blanks at both ends.
std::string_view trim(std::string_view text);

// Without line breaks, of either kind.
std::vector<std::string_view> splitLines(std::string_view text);

// "#ifdef X // why" is {"ifdef", "X"}; a line that is no directive has an empty word.
struct Directive {
    std::string_view word;
    std::string_view argument;
};
Directive parseDirective(std::string_view line);

// The identifiers of a line, comments apart, in order.
std::vector<std::string_view> identifiersOf(std::string_view line);

}  // namespace glint

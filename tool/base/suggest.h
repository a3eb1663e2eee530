// "Did you mean …?"
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace glint {

// Insertions, deletions, substitutions and swaps of neighbours that make `b` of `a` (optimal string
// alignment).
int editDistance(std::string_view a, std::string_view b);

// The candidate nearest to `word`, the first of equals, if it is near enough to be a slip: a third of the
// word's length, at least 1 and at most 3 edits. Else the first that has `word` within it, in whatever case,
// if that is 3 characters or more. Else empty.
std::string nearest(std::string_view word, std::span<const std::string> candidates);

// "; did you mean X?", or nothing.
std::string suggestion(std::string_view word, std::span<const std::string> candidates);

// The first few candidates, " (it has a, b, c and 4 more)"; nothing where there is none. Empty names are left
// out, names with commas are quoted.
std::string enumeration(std::span<const std::string> candidates);

}  // namespace glint

// Suggestions for typos: "Did you mean …?"
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace glint::base {

// Returns how many insertions, deletions, substitutions and swaps of neighbours turn `a` into `b` (optimal
// string alignment).
int editDistance(std::string_view a, std::string_view b);

// Returns the candidate nearest to `word`, or the first of several, if it is near enough to be a typo: a
// third of the word's length, at least 1 and at most 3 edits. Otherwise it returns the first candidate that
// contains `word`, ignoring case, if `word` has at least 3 characters. Otherwise the result is empty.
std::string nearest(std::string_view word, std::span<const std::string> candidates);

// Returns "; did you mean X?", or an empty text.
std::string suggestion(std::string_view word, std::span<const std::string> candidates);

// Lists the first few candidates: " (it has a, b, c and 4 more)". Returns an empty text if there are none.
// Empty names are left out, and names with commas are quoted.
std::string enumeration(std::span<const std::string> candidates);

}  // namespace glint::base

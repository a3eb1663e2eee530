// Texts for people: lists of words, command lines for shells, suggestions for typos.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::base {

// Returns "a, b, c", or "-" for an empty list.
std::string join(const std::vector<std::string>& words);

// Returns "a, b and 4 more" of the texts.
std::string firstOf(const std::vector<std::string>& texts, std::size_t most,
                    std::string_view separator = ", ", std::string_view last = " and ");
// Returns "a; b; and 4 more".
std::string someOf(const std::vector<std::string>& texts, std::size_t most = 5);

// Returns "1 case" or "3 cases".
std::string counted(std::size_t count, std::string_view noun);

// Returns the text in single quotes, as bash and zsh accept them.
std::string shellQuoted(std::string_view text);
// Returns the words as a shell accepts them. Words with characters that have a meaning in a shell are quoted.
std::string shellWords(const std::vector<std::string>& words);

// --- Suggestions for typos: "Did you mean …?" ---

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

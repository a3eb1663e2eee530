// Words as text: lists for people, and command lines for shells.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace glint::base {

// Returns "a, b, c", or "-" for an empty list.
std::string join(const std::vector<std::string>& words);

// Returns "a; b; c" of the first texts, and how many more there are.
std::string someOf(const std::vector<std::string>& texts, std::size_t most = 5);

// Returns the text in single quotes, as bash and zsh accept them.
std::string shellQuoted(std::string_view text);
// Returns the words as a shell accepts them. Words with characters that have a meaning in a shell are quoted.
std::string shellWords(const std::vector<std::string>& words);

}  // namespace glint::base

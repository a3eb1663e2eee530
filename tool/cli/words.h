// Converts command lines to text.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace glint {

// Appends a parsed option as it would be given again, with one word for each value.
void addWords(const CLI::Option& option, std::vector<std::string>& words);

// Returns the text in single quotes, as bash and zsh accept them.
std::string shellQuoted(std::string_view text);
// Returns the words as a shell accepts them. Words with characters that have a meaning in a shell are quoted.
std::string shellWords(const std::vector<std::string>& words);

}  // namespace glint

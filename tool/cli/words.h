// Command lines as text.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace glint {

// Appends a parsed option as it would be given again, a word a value.
void addWords(const CLI::Option& option, std::vector<std::string>& words);

// In single quotes, as bash and zsh take them.
std::string shellQuoted(std::string_view text);
// As a shell takes them: quoted where one has a character that means something to it.
std::string shellWords(const std::vector<std::string>& words);

}  // namespace glint

// Slips of the command line that CLI11 would report as something else, or not at all.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <span>
#include <string>

namespace glint {

struct Slip {
    std::string command;  // empty: glint itself
    std::string message;
};

// Misspelt commands and options, and values that are empty: CLI11 would complain of what is missing because
// of the former, and take the next argument in place of the latter. `arguments` without the program's name.
std::optional<Slip> findSlip(const CLI::App& app, std::span<const char* const> arguments);

}  // namespace glint

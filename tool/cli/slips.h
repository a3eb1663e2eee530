// Finds typos in the command line that CLI11 would report as something else, or not at all.
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

// Finds misspelt commands and options, and empty values. For the former CLI11 would complain about something
// that is missing; for the latter it would take the next argument as the value. `arguments` lack the
// program's name.
std::optional<Slip> findSlip(const CLI::App& app, std::span<const char* const> arguments);

}  // namespace glint

// The layout of --help, and typos in the command line that CLI11 would report as something else, or not at
// all.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <span>
#include <string>

namespace glint::cli {

struct Slip {
    std::string command;  // empty: glint itself
    std::string message;
};

// Finds misspelt commands and options, and empty values. For the former CLI11 would complain about something
// that is missing; for the latter it would take the next argument as the value. `arguments` lack the
// program's name.
std::optional<Slip> findSlip(const CLI::App& app, std::span<const char* const> arguments);

// The formatter of CLI11, without details that the texts of options already give: which options they need and
// exclude, and that lists may be repeated.
class HelpFormatter : public CLI::Formatter {
public:
    std::string make_option_opts(const CLI::Option* option) const override;
};

}  // namespace glint::cli

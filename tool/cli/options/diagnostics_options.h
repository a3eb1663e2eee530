// Options that decide which diagnostics count, by id, and how a command reports: --json, --quiet, --verbose,
// --color, --werror, -W.
#pragma once

#include "cli/console.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace glint::cli {

struct ReportArguments {
    bool json = false;
    bool quiet = false;
    bool verbose = false;
    std::string color = "auto";
    std::vector<std::string> werror;    // "true" for --werror, else an id
    std::vector<std::string> warnings;  // of -W: "no-ID", "error", "error=ID"

    ConsoleOptions options() const;
    // Throws a CLI::ParseError if the options contradict each other.
    void check() const;
};

// Adds the options that every command has; `arguments` must outlive the command. If the command has declared
// --json with its own help text, that stays.
void addReportOptions(CLI::App& command, ReportArguments& arguments);

}  // namespace glint::cli

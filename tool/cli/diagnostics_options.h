// Which diagnostics count, by id, and how a command reports: --json, --quiet, --verbose, --color, --werror,
// -W.
#pragma once

#include "cli/console.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace glint {

struct ReportArguments {
    bool json = false;
    bool quiet = false;
    bool verbose = false;
    std::string color = "auto";
    std::vector<std::string> werror;    // "true" for --werror, else an id
    std::vector<std::string> warnings;  // of -W: "no-ID", "error", "error=ID"

    ConsoleOptions options() const;
    // Throws a CLI::ParseError where they contradict each other.
    void check() const;
};

// Adds the options that every command has; `arguments` must outlive the command. A --json that the command
// has declared itself, with words of its own, stays.
void addReportOptions(CLI::App& command, ReportArguments& arguments);

}  // namespace glint

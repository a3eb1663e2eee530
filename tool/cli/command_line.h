// The `glint` command: subcommands, options, exit codes.
#pragma once

#include "cli/companion.h"
#include "cli/console.h"

namespace glint::cli {

// Parses the command line and does what it says. Results go to stdout, diagnostics to stderr.
int runCommandLine(int argc, const char* const* argv, const Companion& companion = {});

}  // namespace glint::cli

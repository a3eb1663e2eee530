// The `glint` command: subcommands, options, exit codes.
#pragma once

namespace glint::cli {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;  // the input or the work failed
inline constexpr int kExitUsage = 2;   // the command line is wrong

// Parses the command line and does what it says. Results go to stdout, diagnostics to stderr.
int runCommandLine(int argc, const char* const* argv);

}  // namespace glint::cli

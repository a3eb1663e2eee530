// The `glint` command: subcommands, options, exit codes.
#pragma once

#include <glint/result.h>

namespace glint::view {
struct Request;
}  // namespace glint::view

namespace glint::cli {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;  // the input or the work failed
inline constexpr int kExitUsage = 2;   // the command line is wrong

// Opens a window and returns when it is closed.
using ShowWindow = Status (*)(const view::Request& request);

// Parses the command line and does what it says. Results go to stdout, diagnostics to stderr. Without
// `showWindow`, `glint view` starts the program glint-view, which has one.
int runCommandLine(int argc, const char* const* argv, ShowWindow showWindow = nullptr);

}  // namespace glint::cli

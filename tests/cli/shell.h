// Runs programs other than `glint`, for tests that need them.
#pragma once

#include "cli/command.h"

#include <filesystem>
#include <string>

namespace glint::testing {

// Runs a line of sh in `folder`. Both of its output streams are in Outcome::out.
Outcome runShell(const std::filesystem::path& folder, const std::string& line);

// Returns whether PATH has the program.
bool hasProgram(const std::string& name);

// Returns `text` as one word of sh.
std::string quoteForShell(const std::string& text);

}  // namespace glint::testing

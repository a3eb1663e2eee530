// Other programs than `glint`, for tests that need them.
#pragma once

#include "cli/command.h"

#include <filesystem>
#include <string>

namespace glint::testing {

// Runs a line of sh in `folder`. Both of its streams are in Outcome::out.
Outcome runShell(const std::filesystem::path& folder, const std::string& line);

// Whether PATH has it.
bool hasProgram(const std::string& name);

// `text` as one word of sh.
std::string quoteForShell(const std::string& text);

}  // namespace glint::testing

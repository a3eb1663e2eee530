// The table of settings. The options of the command line with their help, their checks and their completion,
// files of settings, the sweeps of a bench, the settings in a manifest and the table in docs/cli.md follow
// from it.
#pragma once

#include "settings/descriptor.h"

#include <span>
#include <string_view>

namespace glint::compiler {

// Rows of the same name have no command in common.
std::span<const Descriptor> settingsTable();
// Returns the row that a bench sweeps; null for other names.
const Descriptor* sweptSetting(std::string_view name);

}  // namespace glint::compiler

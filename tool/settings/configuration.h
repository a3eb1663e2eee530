// Settings by name, as command lines, files and a bench's points have them.
#pragma once

#include "settings/descriptor.h"
#include "settings/settings.h"

#include <string>
#include <vector>

namespace glint::compiler {

// Returns the names of the settings that a bench sweeps, in the order of the table.
std::vector<std::string> settingNames();
// Returns the value of every setting of settingNames().
Configuration configurationOf(const Settings& settings);
// Returns `settings` with the values of `configuration`, which must be valid.
Settings withSettings(Settings settings, const Configuration& configuration);
// Returns the words of a command line: {"--spp", "4"}.
std::vector<std::string> wordsOf(const Configuration& configuration);

}  // namespace glint::compiler

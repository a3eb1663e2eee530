// Files of settings: docs/schemas/settings.json.
#pragma once

#include "settings/descriptor.h"

#include <glint/result.h>

#include <filesystem>
#include <string>

namespace glint::measure {

// Returns the text of a file. `origin` is the command line that it comes from.
std::string settingsText(const compiler::Configuration& settings, const std::string& origin);

// Has the errors of readFile(), and "settings-file" if the file has another format or a setting that Glint
// does not know.
Result<compiler::Configuration> readSettings(const std::filesystem::path& file);

// Returns the error "settings-file" about the place `pointer` of a file, or about the whole file if that is
// empty.
Diagnostic settingsError(const std::filesystem::path& file, const std::string& pointer,
                         const std::string& message, const std::string& hint);

}  // namespace glint::measure

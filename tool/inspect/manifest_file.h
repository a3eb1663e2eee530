// The file manifest.json of a package.
#pragma once

#include "base/json.h"

#include <glint/result.h>

#include <filesystem>
#include <string>

namespace glint::inspect {

// Returns the error "manifest-format" of a package's manifest.
Diagnostic manifestError(const std::filesystem::path& folder, const std::string& why);

// Has the errors of readFile(), and "manifest-format" if the file is no JSON object.
Result<base::Json> readManifestFile(const std::filesystem::path& folder);

}  // namespace glint::inspect

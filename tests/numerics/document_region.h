// The generated regions of documents.
#pragma once

#include <glint/result.h>

#include <string>

namespace glint::numerics {

// Returns `document` with the text between the markers "<!-- begin NAME -->" and "<!-- end NAME -->"
// replaced. Error "report-marker" if it lacks them.
Result<std::string> replaceRegion(const std::string& document, const std::string& name,
                                  const std::string& region);

}  // namespace glint::numerics

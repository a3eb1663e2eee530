// Reads environment maps from files.
#pragma once

#include <glint/context.h>
#include <glint/environment.h>
#include <glint/result.h>

#include <memory>
#include <string>
#include <vector>

namespace glint::scene_view {

// Reads an equirectangular .hdr or .exr file (radiance, linear Rec. 709) and makes the map, which the caller
// owns and which must not outlive `context`. Appends warnings about the file and notes about how it is used.
// Errors: of the file
// ("file-open", "image-format", …) and of Environment::create(), with the file as their place.
Result<std::unique_ptr<Environment>> loadEnvironment(Context& context, const std::string& file,
                                                     const EnvironmentOptions& options,
                                                     std::vector<Diagnostic>& notes);

}  // namespace glint::scene_view

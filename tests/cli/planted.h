// Faults that a test puts into a compiled package.
#pragma once

#include <filesystem>
#include <string>

namespace glint::testing {

// Compiles the source of a module again with `from` replaced by `to`, and puts what comes of it into the
// package's tables. `source`: below `package`, made by `glint compile --emit glsl`; a compute shader. Fails
// the test where `from` is not in it or nothing compiles.
void plant(const std::filesystem::path& package, const std::string& source, const std::string& from,
           const std::string& to);

}  // namespace glint::testing

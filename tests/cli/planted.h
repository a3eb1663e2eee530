// Plants faults into a compiled package.
#pragma once

#include <filesystem>
#include <string>

namespace glint::testing {

// Compiles the source of a module again with `from` replaced by `to`, and stores the result in the package's
// tables. `source` is a file below `package` from `glint compile --emit glsl`, and must be a compute shader.
// Fails the test if the source lacks `from` or does not compile.
void plant(const std::filesystem::path& package, const std::string& source, const std::string& from,
           const std::string& to);
// Does so in every module of first hits that has the text; one must.
void plantInFirstHits(const std::filesystem::path& package, const std::string& from, const std::string& to);

}  // namespace glint::testing

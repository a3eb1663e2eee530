// Compiled modules that the test programs of a build share: each text is compiled once, not by every test
// that needs it.
#pragma once

#include "cache/module_cache.h"

#include <glint/result.h>

#include <cstdint>
#include <string>
#include <vector>

namespace glint::testing {

// Returns the cache in the folder that the tests of the command use too. It finds a module only if the
// module's whole text, the compiler and Glint's code around the compiler are the same. A change of any of
// them is compiled.
compiler::ModuleCache& sharedModules();

// Returns what compileShader() returns for a compute shader without options.
Result<std::vector<std::uint32_t>> compileComputeOnce(const std::string& name, const std::string& glsl);

}  // namespace glint::testing

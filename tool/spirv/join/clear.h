// Removes declarations of a shader's parts that the joined shader does not read.
#pragma once

#include "spirv/join/parsed_module.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace glint::compiler {

// Removes members of structures that nothing reads, unless `keepMembers`, then variables, types, constants
// and decorations on which nothing depends, and numbers the rest by appearance. The words are those of
// clearJoined(), which takes twenty times as long, because it looks for dead code in all functions. Parts
// have no dead code. Returns no value where removing a member or a function would make code dead, and where
// the module has names or anything else that parts of shaders do not have.
std::optional<std::vector<std::uint32_t>> clearGlobals(const ParsedModule& module, bool keepMembers);

}  // namespace glint::compiler

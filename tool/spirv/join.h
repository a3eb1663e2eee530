// Joins SPIR-V modules: a shader whose functions were compiled by themselves becomes one module.
#pragma once

#include "spirv/reader.h"

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint::compiler {

// Makes a shader from modules of makeLinkable() whose names were kept. The first has the entry point and
// imports functions that the others export. The result has each type, constant, resource and function once:
// two functions are the same if their instructions and decorations are. Equal modules give equal words.
// `keepNames` keeps the names in the result. Errors: "spirv-join" if a function is missing or has another
// type, if modules declare a resource differently, or if a module is no such module.
Result<std::vector<std::uint32_t>> joinModules(std::span<const std::span<const std::uint32_t>> modules,
                                               const std::string& shader, bool keepNames);

// --- Removes declarations of a shader's parts that the joined shader does not read ---

// Removes members of structures that nothing reads, unless `keepMembers`, then variables, types, constants
// and decorations on which nothing depends, and numbers the rest by appearance. The words are those of
// clearJoined(), which takes twenty times as long, because it looks for dead code in all functions. Parts
// have no dead code. Returns no value where removing a member or a function would make code dead, and where
// the module has names or anything else that parts of shaders do not have.
std::optional<std::vector<std::uint32_t>> clearGlobals(const ParsedModule& module, bool keepMembers);

// --- Validates a joined shader on several threads ---

// Divides the functions of a shader among at most `most` groups, as far as that is worth it. Returns a copy
// of the module for each, in which the functions of other groups have no code. The shader is valid if all
// copies are. Returns nothing for a small shader.
std::vector<std::vector<std::uint32_t>> validationCopies(const std::vector<std::uint32_t>& words,
                                                         std::size_t most);

// Has the result of validateSpirv(), which it calls on at most `jobs` threads (0: one for each core).
Status validateJoined(const std::vector<std::uint32_t>& words, const std::string& name, int jobs);

}  // namespace glint::compiler

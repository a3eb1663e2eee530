// Joins SPIR-V modules: a shader whose functions were compiled by themselves becomes one module.
#pragma once

#include <glint/result.h>

#include <cstdint>
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

}  // namespace glint::compiler

// Finds the calls between functions of a SPIR-V module, and controls which functions may be inlined.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace glint::compiler {

struct SpirvFunction {
    std::uint32_t id = 0;
    std::string name;                  // without its parameters; empty if the module keeps no names
    std::size_t controlWord = 0;       // index in the module of the word with its function control
    std::vector<std::uint32_t> calls;  // IDs of called functions, in order, with repeats
};

// Requires a valid module.
std::vector<SpirvFunction> findFunctions(std::span<const std::uint32_t> words);

// Forbids inlining of the functions in `apart`, and allows it for the others.
void keepApart(std::vector<std::uint32_t>& words, const std::vector<SpirvFunction>& functions,
               const std::set<std::uint32_t>& apart);

}  // namespace glint::compiler

// Which function of a SPIR-V module calls which, and which of them may be inlined.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace glint {

struct SpirvFunction {
    std::uint32_t id = 0;
    std::string name;                  // without its parameters; empty where the module keeps no names
    std::size_t controlWord = 0;       // place of its function control in the module
    std::vector<std::uint32_t> calls;  // ids, in order, with repeats
};

// Requires a valid module.
std::vector<SpirvFunction> findFunctions(std::span<const std::uint32_t> words);

// Forbids inlining of the functions that `apart` holds, and allows that of the others.
void keepApart(std::vector<std::uint32_t>& words, const std::vector<SpirvFunction>& functions,
               const std::set<std::uint32_t>& apart);

}  // namespace glint

// SPIR-V modules that are linked with others (SPIR-V specification, "Linkage"). glslang 12 writes none.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint::compiler {

// Names of functions, without parameters.
struct LinkNames {
    std::vector<std::string> exported;
    std::vector<std::string> imported;
    bool keepsEntryPoint = false;  // of a program, which libraries are linked to
};

// Makes a library of a compiled shader whose names were kept: it removes the entry point with its function,
// exports functions under their names, and turns functions to import into declarations. Only functions that
// are called are imported. `keepNames` keeps the other names too. Error "spirv-linkage" if an exported
// function is not there.
Result<std::vector<std::uint32_t>> makeLinkable(std::span<const std::uint32_t> words, const LinkNames& names,
                                                const std::string& shader, bool keepNames);

}  // namespace glint::compiler

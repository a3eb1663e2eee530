// Linkage of functions: libraries made of shaders, and functions of shaders that come as SPIR-V, from HLSL,
// Slang, or a generator of one's own.
#pragma once

#include "spirv/reader.h"

#include <glint/result.h>

#include <span>
#include <string>
#include <string_view>
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

// --- Functions that come as SPIR-V ---

// A module with functions that GLSL declares without bodies.
struct SpirvLibrary {
    std::string file;  // for messages
    SpirvWords words;
    // Those that the GLSL declares without a body, by their names without parameters: those under which the
    // module exports functions, or else OpNames of functions.
    std::vector<std::string> functions;
};

// GLSL without the lines of libraryLine(), in which the functions of libraries have bodies, which do not
// matter.
struct LinkedGlsl {
    std::string glsl;
    std::vector<SpirvLibrary> libraries;
};

// Returns the line of GLSL that stands for the module `bytes` until the text is compiled. Error
// "spirv-functions" if it is no valid module of SPIR-V 1.5 or earlier.
Result<std::string> libraryLine(std::string_view file, std::string_view bytes);
LinkedGlsl takeLibraries(std::string_view glsl);

// Replaces the functions of `words`, whose names were kept, that libraries have. Their parameters may be
// pointers to variables, as those of glslang are, or values. Structures of parameters and results need the
// same members, whatever their names and decorations. Entry points, variables and names of the libraries go.
// Errors: "spirv-functions" if types differ, and those of joinModules().
Result<SpirvWords> linkFunctions(SpirvWords words, std::span<const SpirvLibrary> libraries,
                                 const std::string& shader);

}  // namespace glint::compiler

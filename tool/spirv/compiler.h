// Compiles GLSL to optimised, validated SPIR-V, in process.
#pragma once

#include "spirv/link.h"

#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint::compiler {

enum class ShaderStage { Vertex, Fragment, Compute, RayGeneration, ClosestHit, AnyHit, Miss };

struct ShaderSource {
    std::string name;  // for messages; a message about a line names the file and line of the #line directives
    ShaderStage stage = ShaderStage::Compute;
    std::string glsl;  // flattened: it has no #include
    // Functions that stay functions, each optimised on its own. Everything else is inlined.
    std::vector<std::string> functionsApart{};
};

struct ShaderCompileOptions {
    bool debugInfo = false;  // keeps names
    // Otherwise functions are only folded, each by itself, and drivers inline and simplify. That takes a
    // third of the time. Shaders with mediump are optimised in any case, because it decides about their 16
    // bits.
    bool optimize = true;
    // Makes every operation on floats 16-bit, not only mediump ones. It is for measuring the cost.
    bool halvesAll = false;
};

// Compiles a shader; mediump becomes 16-bit float. The target is Vulkan 1.2 and SPIR-V 1.5, so that every
// device with ray queries or ray tracing pipelines can load it. Thread-safe. Errors: "glsl" (glslang's
// messages, first error first), "spirv-optimize", "spirv-validate".
Result<std::vector<std::uint32_t>> compileShader(const ShaderSource& source,
                                                 const ShaderCompileOptions& options);

// Compiles a shader whose main() calls the functions of a library, and makes the library of it: see
// makeLinkable(). Functions to import have bodies in the source, which do not matter. The library is valid
// SPIR-V 1.5, but no Vulkan shader. Errors are those of compileShader(), and "spirv-linkage".
Result<std::vector<std::uint32_t>> compileLinkable(const ShaderSource& source, const LinkNames& names,
                                                   const ShaderCompileOptions& options);

// Compiles a part of a shader, which joinParts() makes whole: functions that others call, or the entry point
// with calls of functions of others. `names` and the bodies of imported functions are as for
// compileLinkable(). Where the functions of a part share variables with the rest of the shader (a global
// variable of GLSL), the part cannot be compiled by itself; it is then an empty module: see isJoinable().
// Errors are those of compileShader(), and "spirv-linkage".
Result<std::vector<std::uint32_t>> compilePart(const ShaderSource& source, const LinkNames& names,
                                               const ShaderCompileOptions& options);
bool isJoinable(std::span<const std::uint32_t> part);

// Makes a shader of its parts, the one with the entry point first, on at most `jobs` threads (0: one for each
// core). `name` is for messages. Errors are those of joinModules(), "spirv-optimize" and "spirv-validate".
Result<std::vector<std::uint32_t>> joinParts(std::span<const std::span<const std::uint32_t>> parts,
                                             const std::string& name, const ShaderCompileOptions& options,
                                             int jobs = 1);

// Returns a text that is equal for two programs whose compileShader() gives the same words for the same
// source. It consists of the versions of glslang and SPIRV-Tools and a hash of the code around them.
std::string compilerIdentity();
// Returns whether the glslang that this was built with knows GL_EXT_ray_tracing_position_fetch.
bool supportsPositionFetch();
// Return the versions of the libraries: "12.0.0", "v2023.1".
std::string glslangVersion();
std::string spirvToolsVersion();

// Returns the text form of a module, for people.
Result<std::string> disassemble(const std::vector<std::uint32_t>& words);

}  // namespace glint::compiler

// GLSL to optimised, validated SPIR-V, in process.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <string>
#include <vector>

namespace glint {

enum class ShaderStage { Vertex, Fragment, Compute, RayGeneration, ClosestHit, AnyHit, Miss };

struct ShaderSource {
    std::string name;  // for messages; a message about a line names the file and line of the #line directives
    ShaderStage stage = ShaderStage::Compute;
    std::string glsl;  // flattened: no #include left
    // Functions that stay functions, each optimised on its own; everything else is inlined.
    std::vector<std::string> functionsApart{};
};

struct ShaderCompileOptions {
    bool debugInfo = false;  // keep names
    // Every operation on floats in 16 bits, not only what is mediump: for measurements of what that costs.
    bool halvesAll = false;
};

// mediump is 16-bit float. Vulkan 1.2, SPIR-V 1.5: so that every device with ray queries or ray tracing
// pipelines can load it. Thread-safe. Errors: "glsl" (what glslang says, first error first),
// "spirv-optimize", "spirv-validate".
Result<std::vector<std::uint32_t>> compileShader(const ShaderSource& source,
                                                 const ShaderCompileOptions& options);

// Equal for two programs whose compileShader() gives the same words for the same source: versions of glslang
// and SPIRV-Tools, and a hash of the code around them.
std::string compilerIdentity();
// Whether the glslang that this was built with knows GL_EXT_ray_tracing_position_fetch.
bool supportsPositionFetch();
// Its version, "12.0".
std::string glslangVersion();

// Text form of a module, for people.
Result<std::string> disassemble(const std::vector<std::uint32_t>& words);

}  // namespace glint

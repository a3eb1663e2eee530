// Optimises and validates with SPIRV-Tools, in process.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint::compiler {

// Inlines functions and folds code that depends on literal constants, so that the branches of features that a
// case does not have vanish. Each function named in `apart` (the shaders of an uber shader's cases) stays a
// function. It is folded level by level as its callees are inlined, so its size stays that of the code it
// needs, and the time grows with that code rather than with the code of all features. Everything else is
// inlined into main. Structure members that nothing reads are removed, except in ray tracing pipelines;
// `keepNames` keeps names and members. Operations of relaxed precision (GLSL's mediump) become 16-bit, and
// with `halvesAll` every float operation does. `name` is for messages. Error "spirv-optimize".
Result<std::vector<std::uint32_t>> optimizeSpirv(const std::vector<std::uint32_t>& words,
                                                 const std::string& name,
                                                 const std::vector<std::string>& apart, bool keepNames,
                                                 bool halvesAll = false);

// Optimises a part of a shader: everything is inlined into main and the functions named in `apart`, which
// stay functions. Names and members are kept, because the join needs them. Inlining level by level would only
// cost time, because a part's literals decide about its features before anything is inlined. Error
// "spirv-optimize".
Result<std::vector<std::uint32_t>> optimizePart(const std::vector<std::uint32_t>& words,
                                                const std::string& name,
                                                const std::vector<std::string>& apart, bool halvesAll);

// Returns whether the module belongs to a ray tracing pipeline, whose structures keep their members.
bool tracesByPipeline(std::span<const std::uint32_t> words);

// Removes declarations of a joined shader's parts that nothing reads: functions, members, types and
// constants. `keepNames` keeps the members. Error "spirv-optimize".
Status clearJoined(std::vector<std::uint32_t>& words, const std::string& name, bool keepNames);

// The use of a module.
enum class SpirvUse {
    Vulkan,  // a shader for Vulkan 1.2
    Link     // a library, which only SPIR-V itself knows
};

// Validates with scalar block layout. Error "spirv-validate", with the validator's first message.
Status validateSpirv(const std::vector<std::uint32_t>& words, const std::string& name,
                     SpirvUse use = SpirvUse::Vulkan);

}  // namespace glint::compiler

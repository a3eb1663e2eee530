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

// Folds code that depends on literal constants within each function, and removes functions that nothing
// calls. It inlines nothing. Names are removed, unless `keepNames` keeps them. Error "spirv-optimize".
Result<std::vector<std::uint32_t>> foldSpirv(const std::vector<std::uint32_t>& words, const std::string& name,
                                             bool keepNames);

// Returns whether anything in the module may have fewer than 32 bits, as GLSL's mediump allows.
bool relaxesPrecision(std::span<const std::uint32_t> words);

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

// Removes what the exported functions of a library do not need, and all names. Error "spirv-optimize".
Status stripLibrary(std::vector<std::uint32_t>& words, const std::string& name);

// The use of a module.
enum class SpirvUse {
    Vulkan,  // a shader for Vulkan 1.2
    Link     // a library, which only SPIR-V itself knows
};

// Validates with scalar block layout. Error "spirv-validate", with the validator's first message.
Status validateSpirv(const std::vector<std::uint32_t>& words, const std::string& name,
                     SpirvUse use = SpirvUse::Vulkan);

// --- After SPIRV-Tools: ray queries and capabilities take the form that the compilers of GPUs need ---

// Gives each OpRayQueryInitializeKHR its own access chain and load of the acceleration structure, directly
// before it. SPIRV-Tools merges them (local and global value numbering find that they are equal), but Mesa's
// driver of Adreno (25.0) makes invalid code for a structure that is loaded in one block and used in another,
// and drivers of mobile GPUs recognise a query by a load beside it. Only structures and the pointers to them
// are loaded again: the address of a structure does not change within a dispatch.
//
// Then removes the capabilities that nothing in the module needs. glslang declares the capabilities of
// everything that the source declares, even if no remaining code uses it, and a device that lacks one must
// refuse the module.
//
// Loads of addresses get the alignment of 8 bytes, which Vulkan demands of them.
//
// `name` is for messages. Error "spirv-join" if `words` is no module.
Status finishSpirv(std::vector<std::uint32_t>& words, const std::string& name);

// --- Reads neighbouring words of buffers by one load ---

// Replaces loads of neighbouring words behind device addresses by loads of vectors. Not every driver does so:
// Adreno's reads each member of a structure by itself, and computes its 64-bit address anew. Only loads of
// the same block are joined, and none across what may write memory. `name` is for messages.
Status widenLoads(std::vector<std::uint32_t>& words, const std::string& name);

}  // namespace glint::compiler

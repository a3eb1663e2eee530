// The changes to a module after SPIRV-Tools has optimised it: ray queries and capabilities take the form that
// the compilers of GPUs need.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <string>
#include <vector>

namespace glint::compiler {

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

// Reads neighbouring words of buffers by one load.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <string>
#include <vector>

namespace glint::compiler {

// Replaces loads of neighbouring words behind device addresses by loads of vectors. Not every driver does so:
// Adreno's reads each member of a structure by itself, and computes its 64-bit address anew. Only loads of
// the same block are joined, and none across what may write memory. `name` is for messages.
Status widenLoads(std::vector<std::uint32_t>& words, const std::string& name);

}  // namespace glint::compiler

// Validates a joined shader on several threads.
#pragma once

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glint::compiler {

// Divides the functions of a shader among at most `most` groups, as far as that is worth it. Returns a copy
// of the module for each, in which the functions of other groups have no code. The shader is valid if all
// copies are. Returns nothing for a small shader.
std::vector<std::vector<std::uint32_t>> validationCopies(const std::vector<std::uint32_t>& words,
                                                         std::size_t most);

// Has the result of validateSpirv(), which it calls on at most `jobs` threads (0: one for each core).
Status validateJoined(const std::vector<std::uint32_t>& words, const std::string& name, int jobs);

}  // namespace glint::compiler

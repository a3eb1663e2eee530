// SPIRV-Tools in process: optimise and validate.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <string>
#include <vector>

namespace glint {

// Inlines everything and folds what literal constants decide, so that the branches of features that a case
// does not have vanish. Names go unless `keepNames`. `name` is for messages. Error "spirv-optimize".
Result<std::vector<std::uint32_t>> optimizeSpirv(const std::vector<std::uint32_t>& words,
                                                 const std::string& name, bool keepNames);

// Checks against Vulkan 1.2 with scalar block layout. Error "spirv-validate", with the validator's first
// message.
Status validateSpirv(const std::vector<std::uint32_t>& words, const std::string& name);

}  // namespace glint

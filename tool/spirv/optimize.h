// SPIRV-Tools in process: optimise and validate.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <string>
#include <vector>

namespace glint {

// Inlines and folds what literal constants decide, so that the branches of features that a case does not have
// vanish. Each function named in `apart` (the shaders of an uber shader's cases) becomes one of its own,
// folded as it takes in what it calls, level by level: its size stays that of the code it needs, and time
// grows with that, not with the code of all features. Everything else goes into main. Members of
// structures that nothing reads go too, but in ray tracing pipelines. Names and members stay with
// `keepNames`. What is of relaxed precision (GLSL's mediump) becomes 16-bit arithmetic, every float operation
// with `halvesAll`. `name` is for messages. Error "spirv-optimize".
Result<std::vector<std::uint32_t>> optimizeSpirv(const std::vector<std::uint32_t>& words,
                                                 const std::string& name,
                                                 const std::vector<std::string>& apart, bool keepNames,
                                                 bool halvesAll = false);

// Checks against Vulkan 1.2 with scalar block layout. Error "spirv-validate", with the validator's first
// message.
Status validateSpirv(const std::vector<std::uint32_t>& words, const std::string& name);

}  // namespace glint

// Counts instructions of a SPIR-V module.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <span>

namespace glint::compiler {

struct SpirvStatistics {
    std::uint64_t bytes = 0;
    std::uint32_t instructions = 0;    // within functions, without labels and debug lines
    std::uint32_t textureFetches = 0;  // OpImageSample*, OpImageFetch, OpImageGather
    std::uint32_t rayQueries = 0;      // OpRayQueryInitializeKHR
    std::uint32_t branches = 0;        // OpBranchConditional and OpSwitch
    std::uint32_t traces = 0;          // OpTraceRayKHR
    std::uint32_t functions = 0;
};

// Error "spirv-format" if `words` is no SPIR-V module.
Result<SpirvStatistics> measureSpirv(std::span<const std::uint32_t> words);

}  // namespace glint::compiler

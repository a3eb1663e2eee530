// Tells pipelines with equal contents from others, also after their package is gone.
#pragma once

#include <vulkan/vulkan_core.h>

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

namespace glint {

struct RayPipelineSource;

// A hash of all that a pipeline is made from, but for its layout and flags: its stages' SPIR-V and the size
// of its workgroups. 128 bits, so that two pipelines of a program never share one by chance.
struct PipelineIdentity {
    std::uint64_t low = 0;
    std::uint64_t high = 0;

    friend auto operator<=>(const PipelineIdentity&, const PipelineIdentity&) = default;
};

// `stages` are the words of each stage in its order; `number` tells pipelines with the same stages apart.
PipelineIdentity identify(VkPipelineBindPoint point, std::uint64_t number,
                          const std::vector<std::span<const std::uint32_t>>& stages);

// The records of the shader binding table do not count: they are no part of the pipeline.
PipelineIdentity identify(const RayPipelineSource& source);

}  // namespace glint

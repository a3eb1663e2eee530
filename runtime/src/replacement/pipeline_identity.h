// Tells pipelines with equal contents from others, also after their package is gone.
#pragma once

#include <glint/package.h>

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace glint {

struct RayPipelineSource;

// A hash of everything that a pipeline is made from, except its layout and flags: its stages' SPIR-V and the
// size of its workgroups. 128 bits, so that two pipelines of a program never share one by chance.
struct PipelineIdentity {
    std::uint64_t low = 0;
    std::uint64_t high = 0;

    friend bool operator<(const PipelineIdentity& a, const PipelineIdentity& b) {
        return std::tie(a.low, a.high) < std::tie(b.low, b.high);
    }
};

// `stages` are the words of each stage in its order, of modules of the package; `number` tells pipelines with
// the same stages apart.
PipelineIdentity identify(const Package& package, VkPipelineBindPoint point, std::uint64_t number,
                          const std::vector<std::span<const std::uint32_t>>& stages);

// The records of the shader binding table do not count, because they are no part of the pipeline.
PipelineIdentity identify(const Package& package, const RayPipelineSource& source);

}  // namespace glint

// What a driver says of the pipelines that it made, as VK_KHR_pipeline_executable_properties has it.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace glint {

// Names and descriptions are the driver's own.
struct PipelineStatistic {
    std::string name;
    std::string description;
    std::variant<bool, std::int64_t, std::uint64_t, double> value;
};

// A piece of code that a pipeline has on the device: one a stage, or fewer, or more.
struct PipelineExecutable {
    std::string name;
    std::string description;
    VkShaderStageFlags stages = 0;
    std::uint32_t subgroupSize = 0;  // 0: it may vary, or there is none
    std::vector<PipelineStatistic> statistics;
};

struct PipelineStatistics {
    std::string name;  // the role of its module, as in the manifest, and its case, effect or ordering
    // Absent where the driver does not say.
    std::optional<double> creationMs;
    std::optional<bool> cacheHit;
    std::vector<PipelineExecutable> executables;
};

}  // namespace glint

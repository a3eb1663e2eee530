// A driver's report about the pipelines that it made, in the terms of VK_KHR_pipeline_executable_properties.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace glint {

// One number of a driver. The driver chooses the name and the description.
struct PipelineStatistic {
    std::string name;
    std::string description;
    std::variant<bool, std::int64_t, std::uint64_t, double> value;
};

// A piece of code of a pipeline on the device. A driver may make one for each stage, or fewer, or more.
struct PipelineExecutable {
    std::string name;
    std::string description;
    VkShaderStageFlags stages = 0;
    std::uint32_t subgroupSize = 0;  // 0: it may vary, or the driver gives none
    std::vector<PipelineStatistic> statistics;
};

struct PipelineStatistics {
    std::string name;  // the role of its module in the manifest, and its case, effect or ordering
    // These have no value if the driver does not report them.
    std::optional<double> creationMs;
    std::optional<bool> cacheHit;
    std::vector<PipelineExecutable> executables;
};

}  // namespace glint

// A driver's report about the pipelines that it made, in the terms of VK_KHR_pipeline_executable_properties.
#pragma once

#include <glint/package_modules.h>
#include <glint/result.h>

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

class Context;
class Package;

// A pipeline that renderers of a package make.
struct PackagePipeline {
    // Without executables if the device reports none, or if the pipeline could not be made.
    PipelineStatistics statistics;
    // Its modules: first the one that it is named after, with the cases that share its code.
    std::vector<package::ModuleKey> modules;
    std::uint32_t strategies = 0;       // package::Strategy bits of the renderers that have it
    std::optional<Diagnostic> failure;  // the driver's error; no value if it made the pipeline
};

// Makes each pipeline that renderers of the package can have on the device, with every strategy, tracer and
// ordering of both, and destroys it again. May be called from any thread; it takes as long as the driver
// needs. Needs no scene, and submits nothing. A package with the steps of a host gets a layout with the
// descriptors that its modules declare. `threads` is as RendererOptions::pipelineThreads. Errors:
// "device-tracer" and others of Renderer::create() if the device runs no strategy of the package,
// "vulkan-call".
Result<std::vector<PackagePipeline>> makePackagePipelines(Context& context, const Package& package,
                                                          std::uint32_t threads = 0);

}  // namespace glint

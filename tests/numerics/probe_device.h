// Runs probes on the Vulkan device, with the validation layers on.
#pragma once

#include "commands.h"
#include "resources.h"

#include <glint/context.h>

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::numerics {

// A compute pipeline that applies one probe to each of up to ProbeDevice::kBatch inputs.
struct ProbePipeline {
    UniquePipeline pipeline;
    int inputs = 0;
    int outputs = 0;
};

class ProbeDevice {
public:
    static constexpr std::uint32_t kBatch = 65536;

    // Errors: those of Context::createHeadless.
    static Result<std::unique_ptr<ProbeDevice>> create();

    // Compiles the flattened probes with `probe` as the entry. Errors: those of compileShader, "vulkan-call".
    Result<ProbePipeline> compile(const std::string& glsl, std::string_view probe, int inputs, int outputs);

    // outputs.size() / pipeline.outputs elements, at most kBatch.
    Status run(const ProbePipeline& pipeline, std::span<const float> inputs, std::span<float> outputs);

    std::string description() const;
    std::vector<std::string> messages() const;

private:
    ProbeDevice() = default;
    Status initialise();
    Status createLayout();

    std::unique_ptr<Context> context_;
    std::unique_ptr<MemoryPool> pool_;
    Buffer inputs_;
    Buffer outputs_;
    UniquePipelineLayout layout_;
    std::unique_ptr<CommandRunner> runner_;
};

}  // namespace glint::numerics

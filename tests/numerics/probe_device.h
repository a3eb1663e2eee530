// Runs probes on the Vulkan device.
#pragma once

#include "context/commands.h"
#include "context/resources.h"
#include "evaluate.h"
#include "probe_kernel.h"

#include <glint/context.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::numerics {

// A compute pipeline around one probe.
struct ProbePipeline {
    UniquePipeline pipeline;
    int inputs = 0;
    int outputs = 0;
    std::vector<std::uint32_t> spirv;
};

struct ProbeDeviceOptions {
    std::string name;  // part of the wanted device's name; empty: the first that will do
    // With validation layers it uses a device that can run Glint; without them, any device that computes.
    bool validates = true;
};

class ProbeDevice {
public:
    static constexpr std::uint32_t kBatch = 65536;

    // Has the errors of Context::createHeadless or createComputeDevice.
    static Result<std::unique_ptr<ProbeDevice>> create(const ProbeDeviceOptions& options = {});
    ~ProbeDevice();

    // Compiles the probe for up to kBatch inputs. Errors: those of compileShader, "vulkan-call".
    Result<ProbePipeline> compile(std::string_view probe, int inputs, int outputs,
                                  ProbePrecision precision = ProbePrecision::Single);
    // Compiles timedKernel(), with the same errors.
    Result<ProbePipeline> compileTimed(std::string_view probe, int inputs, int outputs,
                                       ProbePrecision precision);

    // Runs outputs.size() / pipeline.outputs elements, at most kBatch.
    Status run(const ProbePipeline& pipeline, std::span<const float> inputs, std::span<float> outputs);

    // Stores the inputs of time(), at most kBatch elements, where pipelines find them.
    void setInputs(std::span<const float> inputs);
    // Returns the milliseconds of device time that `threads` threads (at most kMaxThreads) take to evaluate
    // `repeats` times each, over `count` elements. Errors: "timings-unavailable", "vulkan-call".
    Result<double> time(const ProbePipeline& pipeline, std::uint32_t count, std::uint32_t threads,
                        std::uint32_t repeats);
    static constexpr std::uint32_t kMaxThreads = kBatch * kMaxOutputs;

    std::string description() const;
    // Returns whether the device computes in 16 bits.
    bool hasHalf() const;
    bool isCpu() const;
    // Returns the messages of the validation layers.
    std::vector<std::string> messages() const;

private:
    ProbeDevice() = default;
    Context::State& state() const;
    Status initialise();
    Status createLayout();
    Result<ProbePipeline> make(std::string_view probe, const std::string& glsl, int inputs, int outputs,
                               ProbePrecision precision);
    // Records one dispatch that reads from `inputs`.
    void dispatch(VkCommandBuffer commands, const ProbePipeline& pipeline, const Buffer& inputs,
                  std::uint32_t threads, std::uint32_t count, std::uint32_t repeats) const;

    // Exactly one of the two is set.
    std::unique_ptr<Context> context_;
    std::unique_ptr<Context::State> bare_;
    std::unique_ptr<MemoryPool> pool_;
    Buffer inputs_;
    Buffer outputs_;
    // The inputs of timed kernels, in the device's own memory.
    Buffer timedInputs_;
    Buffer ones_;
    UniquePipelineLayout layout_;
    std::unique_ptr<CommandRunner> runner_;
    std::optional<Timer> timer_;
};

}  // namespace glint::numerics

#include "probe_device.h"

#include "evaluate.h"
#include "shader_modules.h"
#include "spirv/compiler.h"
#include "vulkan_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace glint::numerics {
namespace {

constexpr std::uint32_t kGroup = 64;

struct Pushed {
    VkDeviceAddress inputs = 0;
    VkDeviceAddress outputs = 0;
    std::uint32_t count = 0;
};

// Between the #version line and the rest: what the scene decides, and what PROBE means on the device.
std::string prelude() {
    return fmt::format(
        "#define GLINT_ENERGY_COMPENSATION 1\n"
        "#define PROBE(name) void probe##name(float i[{}], inout float o[{}])\n",
        kMaxInputs, kMaxOutputs);
}

// Arrays are indexed by constants only, so that the optimiser takes them apart.
std::string entry(std::string_view probe, int inputs, int outputs) {
    std::string text = fmt::format(R"(
layout(local_size_x = {}) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Floats {{ float data[]; }};
layout(push_constant, scalar) uniform Block {{ Floats inputs; Floats outputs; uint count; }} block;
void main() {{
    uint element = gl_GlobalInvocationID.x;
    if (element >= block.count) {{
        return;
    }}
    float i[{}];
    float o[{}];
)",
                                   kGroup, kMaxInputs, kMaxOutputs);
    for (int k = 0; k < inputs; ++k) {
        text += fmt::format("    i[{}] = block.inputs.data[element * {}u + {}u];\n", k, inputs, k);
    }
    for (int k = 0; k < outputs; ++k) {
        text += fmt::format("    o[{}] = 0.0;\n", k);
    }
    text += fmt::format("    probe{}(i, o);\n", probe);
    for (int k = 0; k < outputs; ++k) {
        text += fmt::format("    block.outputs.data[element * {}u + {}u] = o[{}];\n", outputs, k, k);
    }
    return text + "}\n";
}

}  // namespace

Result<std::unique_ptr<ProbeDevice>> ProbeDevice::create() {
    HeadlessOptions options;
    options.validation = Validation::Synchronization;
    Result<std::unique_ptr<Context>> context = Context::createHeadless(options);
    if (!context) {
        return context.error();
    }
    std::unique_ptr<ProbeDevice> device(new ProbeDevice);
    device->context_ = std::move(*context);
    if (Status status = device->initialise(); !status) {
        return status.error();
    }
    return device;
}

Status ProbeDevice::initialise() {
    Context::State& state = context_->state();
    pool_ = std::make_unique<MemoryPool>(state);
    constexpr VkBufferUsageFlags kUsage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    Result<Buffer> inputs =
        createBuffer(state, *pool_, sizeof(float) * kMaxInputs * kBatch, kUsage, MemoryUse::Upload);
    if (!inputs) {
        return inputs.error();
    }
    inputs_ = std::move(*inputs);
    Result<Buffer> outputs =
        createBuffer(state, *pool_, sizeof(float) * kMaxOutputs * kBatch, kUsage, MemoryUse::Readback);
    if (!outputs) {
        return outputs.error();
    }
    outputs_ = std::move(*outputs);
    Result<CommandRunner> runner = CommandRunner::create(state);
    if (!runner) {
        return runner.error();
    }
    runner_ = std::make_unique<CommandRunner>(std::move(*runner));
    return createLayout();
}

Status ProbeDevice::createLayout() {
    Context::State& state = context_->state();
    VkPushConstantRange range{};
    range.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    range.size = sizeof(Pushed);
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    const VkResult result = state.vk.CreatePipelineLayout(state.handles.device, &info, nullptr, &layout);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreatePipelineLayout", result);
    }
    layout_ = UniquePipelineLayout(state, layout);
    return okStatus();
}

Result<ProbePipeline> ProbeDevice::compile(const std::string& glsl, std::string_view probe, int inputs,
                                           int outputs) {
    Context::State& state = context_->state();
    // Everything after the directives that must come first.
    const std::size_t firstLine = glsl.find("#line");
    std::string text = glsl;
    text.insert(firstLine == std::string::npos ? 0 : firstLine, prelude());
    text += entry(probe, inputs, outputs);
    const Result<std::vector<std::uint32_t>> words =
        compileShader({std::string(probe), ShaderStage::Compute, text, {}}, {});
    if (!words) {
        return words.error();
    }
    Result<UniquePipeline> pipeline = createComputePipeline(state, *words, layout_.get());
    if (!pipeline) {
        return pipeline.error();
    }
    return ProbePipeline{std::move(*pipeline), inputs, outputs};
}

Status ProbeDevice::run(const ProbePipeline& pipeline, std::span<const float> inputs,
                        std::span<float> outputs) {
    Context::State& state = context_->state();
    std::memcpy(inputs_.mapped, inputs.data(), inputs.size_bytes());
    const Pushed pushed{
        inputs_.address, outputs_.address,
        static_cast<std::uint32_t>(outputs.size()) / static_cast<std::uint32_t>(pipeline.outputs)};
    Result<VkCommandBuffer> commands = runner_->begin();
    if (!commands) {
        return commands.error();
    }
    state.vk.CmdBindPipeline(*commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline.get());
    state.vk.CmdPushConstants(*commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(pushed),
                              &pushed);
    state.vk.CmdDispatch(*commands, (pushed.count + kGroup - 1) / kGroup, 1, 1);
    recordDependency(state, *commands,
                     {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
    if (Status status = runner_->submitAndWait(); !status) {
        return status;
    }
    std::memcpy(outputs.data(), outputs_.mapped, outputs.size_bytes());
    return okStatus();
}

std::string ProbeDevice::description() const {
    return context_->deviceName() + ", " + context_->driverName();
}

std::vector<std::string> ProbeDevice::messages() const {
    return context_->validationMessages();
}

}  // namespace glint::numerics

#include "probe_device.h"

#include "compute_device.h"
#include "context/shader_modules.h"
#include "context/vulkan_table.h"
#include "spirv/compiler.h"

#include <bit>
#include <cstring>
#include <utility>

namespace glint::numerics {
namespace {

// The number of factors by which timed kernels multiply their inputs in turn.
constexpr std::size_t kOnes = 16;

struct Pushed {
    VkDeviceAddress inputs = 0;
    VkDeviceAddress outputs = 0;
    VkDeviceAddress ones = 0;
    std::uint32_t count = 0;
    std::uint32_t repeats = 0;
};

}  // namespace

Result<std::unique_ptr<ProbeDevice>> ProbeDevice::create(const ProbeDeviceOptions& options) {
    std::unique_ptr<ProbeDevice> device(new ProbeDevice);
    if (options.validates) {
        HeadlessOptions headless;
        headless.validation = Validation::Synchronization;
        headless.deviceName = options.name;
        GLINT_TRY(auto context, Context::createHeadless(headless));
        device->context_ = std::move(context);
    } else {
        GLINT_TRY(auto bare, createComputeDevice(options.name));
        device->bare_ = std::move(bare);
    }
    GLINT_TRY_DO(device->initialise());
    return device;
}

ProbeDevice::~ProbeDevice() = default;

Context::State& ProbeDevice::state() const {
    return context_ ? context_->state() : *bare_;
}

Status ProbeDevice::initialise() {
    pool_ = std::make_unique<MemoryPool>(state());
    constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                          VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                                          VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const auto create = [&](Buffer& buffer, VkDeviceSize floats, MemoryUse use) -> Status {
        GLINT_TRY(auto made, createBuffer(state(), *pool_, sizeof(float) * floats, kUsage, use));
        buffer = std::move(made);
        return okStatus();
    };
    Status status = create(inputs_, VkDeviceSize{kMaxInputs} * kBatch, MemoryUse::Upload);
    if (status) {
        status = create(outputs_, VkDeviceSize{kMaxOutputs} * kBatch, MemoryUse::Readback);
    }
    if (status) {
        status = create(timedInputs_, VkDeviceSize{kMaxInputs} * kBatch, MemoryUse::Device);
    }
    if (status) {
        status = create(ones_, kOnes, MemoryUse::Device);
    }
    if (!status) {
        return status;
    }
    GLINT_TRY(auto runner, CommandRunner::create(state()));
    runner_ = std::make_unique<CommandRunner>(std::move(runner));
    GLINT_TRY(auto timer, Timer::create(state(), 1));
    timer_ = std::move(timer);
    return createLayout();
}

Status ProbeDevice::createLayout() {
    GLINT_TRY(layout_, createPipelineLayout(state(), {}, {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(Pushed)}));
    return okStatus();
}

Result<ProbePipeline> ProbeDevice::make(std::string_view probe, const std::string& glsl, int inputs,
                                        int outputs, ProbePrecision precision) {
    compiler::ShaderCompileOptions options;
    options.halvesAll = precision == ProbePrecision::Half;
    GLINT_TRY(auto words, compiler::compileShader(
                              {std::string(probe), compiler::ShaderStage::Compute, glsl, {}}, options));
    GLINT_TRY(auto pipeline, createComputePipeline(state(), words, layout_.get()));
    return ProbePipeline{std::move(pipeline), inputs, outputs, std::move(words)};
}

Result<ProbePipeline> ProbeDevice::compile(std::string_view probe, int inputs, int outputs,
                                           ProbePrecision precision) {
    return make(probe, probeKernel(probe, inputs, outputs, precision), inputs, outputs, precision);
}

Result<ProbePipeline> ProbeDevice::compileTimed(std::string_view probe, int inputs, int outputs,
                                                ProbePrecision precision) {
    return make(probe, timedKernel(probe, inputs, outputs, precision), inputs, outputs, precision);
}

void ProbeDevice::dispatch(VkCommandBuffer commands, const ProbePipeline& pipeline, const Buffer& inputs,
                           std::uint32_t threads, std::uint32_t count, std::uint32_t repeats) const {
    const DeviceTable& vk = state().vk;
    const Pushed pushed{inputs.address, outputs_.address, ones_.address, count, repeats};
    vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline.get());
    vk.CmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(pushed), &pushed);
    vk.CmdDispatch(commands, (threads + kProbeGroup - 1) / kProbeGroup, 1, 1);
}

Status ProbeDevice::run(const ProbePipeline& pipeline, std::span<const float> inputs,
                        std::span<float> outputs) {
    setInputs(inputs);
    const auto count =
        static_cast<std::uint32_t>(outputs.size()) / static_cast<std::uint32_t>(pipeline.outputs);
    GLINT_TRY(auto commands, runner_->begin());
    dispatch(commands, pipeline, inputs_, count, count, 1);
    recordDependency(state(), commands,
                     {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
    GLINT_TRY_DO(runner_->submitAndWait());
    std::memcpy(outputs.data(), outputs_.mapped, outputs.size_bytes());
    return okStatus();
}

void ProbeDevice::setInputs(std::span<const float> inputs) {
    std::memcpy(inputs_.mapped, inputs.data(), inputs.size_bytes());
}

Result<double> ProbeDevice::time(const ProbePipeline& pipeline, std::uint32_t count, std::uint32_t threads,
                                 std::uint32_t repeats) {
    GLINT_TRY(auto commands, runner_->begin());
    const DeviceTable& vk = state().vk;
    const VkBufferCopy copy{0, 0, sizeof(float) * count * static_cast<VkDeviceSize>(pipeline.inputs)};
    vk.CmdCopyBuffer(commands, inputs_.handle.get(), timedInputs_.handle.get(), 1, &copy);
    vk.CmdFillBuffer(commands, ones_.handle.get(), 0, VK_WHOLE_SIZE, std::bit_cast<std::uint32_t>(1.0F));
    recordDependency(state(), commands,
                     {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT});
    timer_->recordReset(commands);
    timer_->recordBegin(commands, 0);
    dispatch(commands, pipeline, timedInputs_, threads, count, repeats);
    timer_->recordEnd(commands, 0);
    GLINT_TRY_DO(runner_->submitAndWait());
    const Result<std::vector<double>> times = timer_->read(1);
    return times ? Result<double>(times->front()) : times.error();
}

std::string ProbeDevice::description() const {
    return state().limits.deviceName + ", " + state().limits.driverName;
}

bool ProbeDevice::hasHalf() const {
    return state().handles.shaderFloat16;
}

bool ProbeDevice::isCpu() const {
    VkPhysicalDeviceProperties properties{};
    state().instance.GetPhysicalDeviceProperties(state().handles.physicalDevice, &properties);
    return properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

std::vector<std::string> ProbeDevice::messages() const {
    return context_ ? context_->validationMessages() : std::vector<std::string>();
}

}  // namespace glint::numerics

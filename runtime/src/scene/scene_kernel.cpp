#include "scene/scene_kernel.h"

#include "context/commands.h"
#include "context/context.h"
#include "context/device_objects.h"
#include "context/shader_modules.h"
#include "context/vulkan_table.h"
#include "scene/gpu_scene_state.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace glint {
namespace {

Result<UniquePipelineLayout> createKernelLayout(GpuScene::State& scene) {
    Context::State& context = scene.context;
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(gpu::PushConstants)};
    const VkDescriptorSetLayout sets[] = {scene.setLayout.get()};
    return createPipelineLayout(context, sets, range);
}

// The memory of one run.
struct RunBuffers {
    explicit RunBuffers(Context::State& context) : pool(context) {}

    Status create(Context::State& context, std::size_t inputBytes, std::size_t outputBytes) {
        const struct {
            Buffer& buffer;
            std::size_t bytes;
            MemoryUse use;
        } wanted[] = {{frame, sizeof(gpu::FrameConstants), MemoryUse::Upload},
                      {input, std::max<std::size_t>(inputBytes, 1), MemoryUse::Upload},
                      {output, std::max<std::size_t>(outputBytes, 1), MemoryUse::Readback}};
        for (const auto& [buffer, bytes, use] : wanted) {
            GLINT_TRY(buffer, createBuffer(context, pool, bytes,
                                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                               VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                                           use));
        }
        return okStatus();
    }

    MemoryPool pool;
    Buffer frame;
    Buffer input;
    Buffer output;
};

}  // namespace

SceneKernel::SceneKernel(std::unique_ptr<State> state) : state_(std::move(state)) {}
SceneKernel::~SceneKernel() = default;

SceneKernel::State& SceneKernel::state() {
    return *state_;
}

Result<std::unique_ptr<SceneKernel>> SceneKernel::create(GpuScene& scene,
                                                         std::span<const std::uint32_t> words) {
    GLINT_TRY(auto layout, createKernelLayout(scene.state()));
    GLINT_TRY(auto pipeline, createComputePipeline(scene.state().context, words, layout.get()));
    return std::unique_ptr<SceneKernel>(new SceneKernel(
        std::make_unique<State>(State{scene.state(), std::move(layout), std::move(pipeline)})));
}

Result<std::vector<std::uint32_t>> SceneKernel::run(std::span<const std::uint32_t> input,
                                                    std::uint32_t invocations, std::size_t outputs) {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(input.data());
    return runSceneKernel(*state_, {}, {bytes, input.size_bytes()}, invocations, outputs);
}

Result<std::vector<std::uint32_t>> runSceneKernel(SceneKernel::State& kernel, gpu::FrameConstants constants,
                                                  std::span<const std::uint8_t> input,
                                                  std::uint32_t invocations, std::size_t outputs) {
    GpuScene::State& scene = kernel.scene;
    Context::State& context = scene.context;
    const std::size_t outputBytes = outputs * sizeof(std::uint32_t);
    RunBuffers buffers(context);
    GLINT_TRY_DO(buffers.create(context, input.size_bytes(), outputBytes));
    GLINT_TRY(auto runner, CommandRunner::create(context));
    constants.width = invocations;
    fillScene(scene, constants);
    constants.rays = buffers.input.address;
    constants.orderedHits = buffers.input.address;
    constants.counters = buffers.output.address;
    std::memcpy(buffers.frame.mapped, &constants, sizeof(constants));
    std::copy(input.begin(), input.end(), buffers.input.mapped);
    std::fill_n(buffers.output.mapped, outputBytes, std::uint8_t{0});

    GLINT_TRY(auto commands, runner.begin());
    gpu::PushConstants pushed{};
    pushed.frame = buffers.frame.address;
    const DeviceTable& vk = context.vk;
    vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline.get());
    vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.layout.get(), gpu::kSetScene, 1,
                             &scene.set, 0, nullptr);
    vk.CmdPushConstants(commands, kernel.layout.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(pushed),
                        &pushed);
    vk.CmdDispatch(commands, (invocations + gpu::kRayGroupSize - 1) / gpu::kRayGroupSize, 1, 1);
    recordDependency(context, commands,
                     {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
    GLINT_TRY_DO(runner.submitAndWait());
    std::vector<std::uint32_t> words(outputs);
    std::memcpy(words.data(), buffers.output.mapped, outputBytes);
    return words;
}

}  // namespace glint

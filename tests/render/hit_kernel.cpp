#include "render/hit_kernel.h"

#include "base/files.h"
#include "context/context_state.h"
#include "context/vulkan_error.h"
#include "emit/glsl/flatten.h"
#include "emit/sources.h"
#include "package/shader_modules.h"
#include "scene/gpu_scene_state.h"
#include "spirv/compiler.h"

#include <cstring>

namespace glint::testing {

namespace {

Result<std::vector<std::uint32_t>> compileKernel(const Scene& scene, const LoadedScene& loaded,
                                                 const std::string& shader) {
    const Result<Bytes> text =
        readFile(std::filesystem::path(GLINT_SOURCE_DIR) / "tests" / "render" / "shaders" / shader);
    if (!text) {
        return text.error();
    }
    const Result<SourceSet> sources = makeSourceSet(SceneList({&scene, 1}), loaded.compiled().plan, {});
    if (!sources) {
        return sources.error();
    }
    const Result<std::string> glsl =
        flatten(shader, std::string(text->begin(), text->end()), sources->lookup(), FlattenSide::Glsl);
    if (!glsl) {
        return glsl.error();
    }
    return compileShader({shader, ShaderStage::Compute, *glsl}, {});
}

}  // namespace

HitKernel::HitKernel(GpuScene::State& scene) : scene_(scene) {}

Result<std::unique_ptr<HitKernel>> HitKernel::create(const Scene& scene, const LoadedScene& loaded,
                                                     const std::string& shader) {
    const Result<std::vector<std::uint32_t>> words = compileKernel(scene, loaded, shader);
    return words ? create(loaded, *words) : words.error();
}

Result<std::unique_ptr<HitKernel>> HitKernel::create(const LoadedScene& loaded,
                                                     const std::vector<std::uint32_t>& words) {
    std::unique_ptr<HitKernel> kernel(new HitKernel(loaded.gpuScene().state()));
    if (Status status = kernel->createPipeline(words); !status) {
        return status.error();
    }
    return kernel;
}

Status HitKernel::createPipeline(const std::vector<std::uint32_t>& words) {
    Context::State& state = scene_.context;
    const VkDevice device = state.handles.device;
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(gpu::PushConstants)};
    const VkDescriptorSetLayout sets[] = {scene_.setLayout.get()};
    VkPipelineLayoutCreateInfo layoutInfo{};
    layoutInfo.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layoutInfo.setLayoutCount = 1;
    layoutInfo.pSetLayouts = sets;
    layoutInfo.pushConstantRangeCount = 1;
    layoutInfo.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    const VkResult result = state.vk.CreatePipelineLayout(device, &layoutInfo, nullptr, &layout);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreatePipelineLayout", result);
    }
    layout_ = UniquePipelineLayout(state, layout);

    Result<UniquePipeline> pipeline = createComputePipeline(state, words, layout_.get());
    if (!pipeline) {
        return pipeline.error();
    }
    pipeline_ = std::move(*pipeline);
    return okStatus();
}

Result<std::vector<std::uint32_t>> HitKernel::run(gpu::FrameConstants constants,
                                                  std::span<const gpu::RayRecord> rays,
                                                  std::uint32_t invocations, std::size_t outputs) {
    Context::State& state = scene_.context;
    MemoryPool pool(state);
    constexpr VkBufferUsageFlags kUsage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    Result<Buffer> frame = createBuffer(state, pool, sizeof(constants), kUsage, MemoryUse::Upload);
    Result<Buffer> input =
        createBuffer(state, pool, std::max<VkDeviceSize>(rays.size_bytes(), 1), kUsage, MemoryUse::Upload);
    Result<Buffer> output =
        createBuffer(state, pool, outputs * sizeof(std::uint32_t), kUsage, MemoryUse::Readback);
    Result<CommandRunner> runner = CommandRunner::create(state);
    if (!frame || !input || !output || !runner) {
        return makeError("kernel", "", "no memory or commands for a kernel", "use fewer rays");
    }
    constants.width = invocations;
    constants.geometries = scene_.geometries.address;
    constants.instances = scene_.instances.address;
    constants.materials = scene_.materials.address;
    constants.lights = scene_.lights.address;
    constants.lightCount = scene_.lightCount;
    constants.rays = input->address;
    constants.counters = output->address;
    std::memcpy(frame->mapped, &constants, sizeof(constants));
    std::memcpy(input->mapped, rays.data(), rays.size_bytes());
    std::memset(output->mapped, 0, outputs * sizeof(std::uint32_t));

    Result<VkCommandBuffer> commands = runner->begin();
    if (!commands) {
        return commands.error();
    }
    gpu::PushConstants pushed{};
    pushed.frame = frame->address;
    state.vk.CmdBindPipeline(*commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    state.vk.CmdBindDescriptorSets(*commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), gpu::kSetScene,
                                   1, &scene_.set, 0, nullptr);
    state.vk.CmdPushConstants(*commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(pushed),
                              &pushed);
    state.vk.CmdDispatch(*commands, (invocations + gpu::kRayGroupSize - 1) / gpu::kRayGroupSize, 1, 1);
    recordDependency(state, *commands,
                     {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
    if (Status status = runner->submitAndWait(); !status) {
        return status.error();
    }
    std::vector<std::uint32_t> words(outputs);
    std::memcpy(words.data(), output->mapped, outputs * sizeof(std::uint32_t));
    return words;
}

}  // namespace glint::testing

#include "oracle/traversal/trace_kernel.h"

#include "context/context.h"
#include "context/shader_modules.h"
#include "context/vulkan_table.h"
#include "spirv/compiler.h"

#include <cstring>

namespace glint::traversal {
namespace {

constexpr const char* kShader = R"(#version 460
#extension GL_EXT_ray_query : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT sceneTlas[1];
struct Ray { vec3 origin; vec3 direction; };
layout(buffer_reference, scalar) readonly buffer Rays { Ray data[]; };
layout(buffer_reference, scalar) writeonly buffer Distances { float data[]; };
layout(push_constant, scalar) uniform Pushed { Rays rays; Distances distances; uint count; };
void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= count) {
        return;
    }
    Ray ray = rays.data[index];
    rayQueryEXT query;
    rayQueryInitializeEXT(query, sceneTlas[0], gl_RayFlagsOpaqueEXT, 0xFFu, ray.origin, 0.0, ray.direction, 1e30);
    rayQueryProceedEXT(query);
    bool isHit = rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
    distances.data[index] = isHit ? rayQueryGetIntersectionTEXT(query, true) : -1.0;
}
)";

// The members are those of the shader.
struct Pushed {
    VkDeviceAddress rays;
    VkDeviceAddress distances;
    std::uint32_t count;
};

}  // namespace

Result<std::unique_ptr<TraceKernel>> TraceKernel::create(Context& context, VkDescriptorSetLayout layout,
                                                         std::size_t rays) {
    Context::State& state = context.state();
    GLINT_TRY(auto runner, CommandRunner::create(state));
    GLINT_TRY(auto timer, Timer::create(state, 1));
    std::unique_ptr<TraceKernel> kernel(new TraceKernel(state, std::move(runner), std::move(timer)));
    constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    Result<Buffer> input = createBuffer(state, kernel->pool_, rays * sizeof(Ray), kUsage, MemoryUse::Upload);
    Result<Buffer> output =
        createBuffer(state, kernel->pool_, rays * sizeof(float), kUsage, MemoryUse::Readback);
    if (!input || !output) {
        return !input ? input.error() : output.error();
    }
    kernel->rays_ = std::move(*input);
    kernel->distances_ = std::move(*output);
    GLINT_TRY_DO(kernel->createPipeline(layout));
    return kernel;
}

Status TraceKernel::createPipeline(VkDescriptorSetLayout layout) {
    GLINT_TRY(layout_, createPipelineLayout(context_, std::span(&layout, 1),
                                            {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(Pushed)}));
    GLINT_TRY(const auto words,
              compiler::compileShader({"trace", compiler::ShaderStage::Compute, kShader}, {}));
    GLINT_TRY(pipeline_, createComputePipeline(context_, words, layout_.get()));
    return okStatus();
}

Result<double> TraceKernel::trace(GpuScene& scene, std::span<const Ray> rays) {
    count_ = rays.size();
    std::memcpy(rays_.mapped, rays.data(), rays.size_bytes());
    GLINT_TRY(const auto commands, runner_.begin());
    const auto count = static_cast<std::uint32_t>(rays.size());
    const Pushed pushed{rays_.address, distances_.address, count};
    const DeviceTable& vk = context_.vk;
    timer_.recordReset(commands);
    vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0, 1,
                             &scene.state().set, 0, nullptr);
    vk.CmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(pushed), &pushed);
    timer_.recordBegin(commands, 0);
    vk.CmdDispatch(commands, (count + 63) / 64, 1, 1);
    timer_.recordEnd(commands, 0);
    recordDependency(context_, commands,
                     {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
    GLINT_TRY_DO(runner_.submitAndWait());
    GLINT_TRY(const auto milliseconds, timer_.read(1));
    return milliseconds.front();
}

std::span<const float> TraceKernel::distances() const {
    return {reinterpret_cast<const float*>(distances_.mapped), count_};
}

}  // namespace glint::traversal

#include "pipelines.h"

#include <cstring>
#include <iterator>
#include <vector>

namespace engine {

VkPipeline computePipeline(Gpu& gpu, VkPipelineLayout layout, const std::string& shader) {
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = gpu.shader(shader);
    info.stage.pName = "main";
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateComputePipelines(gpu.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
          "vkCreateComputePipelines");
    gpu.later([device = gpu.device, pipeline] { vkDestroyPipeline(device, pipeline, nullptr); });
    return pipeline;
}

VkPipeline gbufferPipeline(Gpu& gpu, VkPipelineLayout layout, const std::string& shaders, VkExtent2D extent,
                           VkFormat seen, VkFormat depth) {
    VkPipelineShaderStageCreateInfo stages[2]{};
    for (VkPipelineShaderStageCreateInfo& stage : stages) {
        const bool vertex = &stage == stages;
        stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        stage.stage = vertex ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
        stage.module = gpu.shader(shaders + (vertex ? "/gbuffer.vert.spv" : "/gbuffer.frag.spv"));
        stage.pName = "main";
    }
    VkPipelineVertexInputStateCreateInfo input{};
    input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height),
                              0, 1};
    const VkRect2D scissor{{0, 0}, extent};
    VkPipelineViewportStateCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    view.viewportCount = view.scissorCount = 1;
    view.pViewports = &viewport;
    view.pScissors = &scissor;
    VkPipelineRasterizationStateCreateInfo raster{};
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.cullMode = VK_CULL_MODE_BACK_BIT;
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1.0F;
    VkPipelineMultisampleStateCreateInfo samples{};
    samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depthState{};
    depthState.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depthState.depthTestEnable = depthState.depthWriteEnable = VK_TRUE;
    depthState.depthCompareOp = VK_COMPARE_OP_GREATER;
    VkPipelineColorBlendAttachmentState attachment{};
    attachment.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT;
    VkPipelineColorBlendStateCreateInfo blend{};
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = 1;
    blend.pAttachments = &attachment;
    VkPipelineRenderingCreateInfo rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachmentFormats = &seen;
    rendering.depthAttachmentFormat = depth;
    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.pNext = &rendering;
    info.stageCount = 2;
    info.pStages = stages;
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &view;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depthState;
    info.pColorBlendState = &blend;
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateGraphicsPipelines(gpu.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
          "vkCreateGraphicsPipelines");
    gpu.later([device = gpu.device, pipeline] { vkDestroyPipeline(device, pipeline, nullptr); });
    return pipeline;
}

PrimaryPass::PrimaryPass(Gpu& gpu, VkPipelineLayout layout, const std::string& shaders,
                         glint::package::Tracer tracer) {
    if (tracer == glint::package::kTracerRayQuery) {
        pipeline_ = computePipeline(gpu, layout, shaders + "/primary.comp.spv");
    } else {
        makeRayPipeline(gpu, layout, shaders);
    }
}

void PrimaryPass::makeRayPipeline(Gpu& gpu, VkPipelineLayout layout, const std::string& shaders) {
    const auto load = [&](auto& function, const char* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(
            vkGetDeviceProcAddr(gpu.device, name));
    };
    PFN_vkCreateRayTracingPipelinesKHR createPipelines = nullptr;
    PFN_vkGetRayTracingShaderGroupHandlesKHR groupHandles = nullptr;
    load(createPipelines, "vkCreateRayTracingPipelinesKHR");
    load(groupHandles, "vkGetRayTracingShaderGroupHandlesKHR");
    load(traceRays_, "vkCmdTraceRaysKHR");

    // Ray generation, miss, and a hit group without a shader.
    constexpr std::uint32_t kGroups = 3;
    const char* const files[] = {"/primary.rgen.spv", "/primary.rmiss.spv"};
    VkPipelineShaderStageCreateInfo stages[2]{};
    VkRayTracingShaderGroupCreateInfoKHR groups[kGroups]{};
    for (std::uint32_t i = 0; i < kGroups; ++i) {
        groups[i].sType = VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR;
        groups[i].type = VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR;
        groups[i].generalShader = groups[i].closestHitShader = groups[i].anyHitShader =
            groups[i].intersectionShader = VK_SHADER_UNUSED_KHR;
        if (i < std::size(stages)) {
            stages[i].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
            stages[i].stage = i == 0 ? VK_SHADER_STAGE_RAYGEN_BIT_KHR : VK_SHADER_STAGE_MISS_BIT_KHR;
            stages[i].module = gpu.shader(shaders + files[i]);
            stages[i].pName = "main";
            groups[i].type = VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR;
            groups[i].generalShader = i;
        }
    }
    VkRayTracingPipelineCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR;
    info.stageCount = std::size(stages);
    info.pStages = stages;
    info.groupCount = kGroups;
    info.pGroups = groups;
    info.maxPipelineRayRecursionDepth = 1;
    info.layout = layout;
    check(createPipelines(gpu.device, VK_NULL_HANDLE, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_),
          "vkCreateRayTracingPipelinesKHR");
    gpu.later([device = gpu.device, made = pipeline_] { vkDestroyPipeline(device, made, nullptr); });

    // The shader binding table: a record for each group, each where a region may begin.
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR limits{};
    limits.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &limits;
    vkGetPhysicalDeviceProperties2(gpu.physical, &properties);
    const std::uint32_t bytes = limits.shaderGroupHandleSize;
    const VkDeviceSize apart = (VkDeviceSize{bytes} + limits.shaderGroupBaseAlignment - 1) /
                               limits.shaderGroupBaseAlignment * limits.shaderGroupBaseAlignment;
    std::vector<std::uint8_t> handles(std::size_t{kGroups} * bytes);
    check(groupHandles(gpu.device, pipeline_, 0, kGroups, handles.size(), handles.data()),
          "vkGetRayTracingShaderGroupHandlesKHR");
    // One record more than needed, so that the first may begin at an aligned address.
    const Buffer table =
        gpu.buffer((kGroups + 1) * apart, true, VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR);
    const VkDeviceAddress first = (table.address + limits.shaderGroupBaseAlignment - 1) /
                                  limits.shaderGroupBaseAlignment * limits.shaderGroupBaseAlignment;
    VkStridedDeviceAddressRegionKHR* const regions[] = {&generation_, &miss_, &hit_};
    for (std::uint32_t i = 0; i < kGroups; ++i) {
        *regions[i] = {first + i * apart, apart, apart};
        std::memcpy(static_cast<std::uint8_t*>(table.mapped) + (first - table.address) + i * apart,
                    handles.data() + std::size_t{i} * bytes, bytes);
    }
}

void PrimaryPass::record(VkCommandBuffer commands, VkExtent2D extent) const {
    if (traceRays_ == nullptr) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
        vkCmdDispatch(commands, (extent.width + 7) / 8, (extent.height + 7) / 8, 1);
        return;
    }
    const VkStridedDeviceAddressRegionKHR none{};
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline_);
    traceRays_(commands, &generation_, &miss_, &hit_, &none, extent.width, extent.height, 1);
}

}  // namespace engine

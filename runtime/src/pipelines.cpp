#include "pipelines.h"

#include "frame_resources.h"
#include "ray_passes.h"
#include "shader_modules.h"
#include "vulkan_error.h"

#include <array>
#include <chrono>

namespace glint {
namespace {

using package::ModuleRole;

Status createLayout(Context::State& context, std::span<const VkDescriptorSetLayout> setLayouts,
                    Pipelines& pipelines) {
    VkPushConstantRange range{};
    range.stageFlags = pushStages(context);
    range.size = sizeof(gpu::PushConstants);
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = static_cast<std::uint32_t>(setLayouts.size());
    info.pSetLayouts = setLayouts.data();
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    const VkResult result = context.vk.CreatePipelineLayout(context.handles.device, &info, nullptr, &layout);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreatePipelineLayout", result);
    }
    pipelines.layout = UniquePipelineLayout(context, layout);
    return okStatus();
}

// Vertices are pulled by address, so there is no vertex input; reversed depth; facing set draw by draw.
Result<VkPipeline> createGBuffer(Context::State& context, const Package& package, Pipelines& pipelines) {
    Result<UniqueShaderModule> vertex =
        createShaderModule(context, package.spirv({ModuleRole::GBufferVertex}));
    if (!vertex) {
        return vertex.error();
    }
    Result<UniqueShaderModule> fragment =
        createShaderModule(context, package.spirv({ModuleRole::GBufferFragment}));
    if (!fragment) {
        return fragment.error();
    }
    const std::array stages{stageOf(VK_SHADER_STAGE_VERTEX_BIT, vertex->get()),
                            stageOf(VK_SHADER_STAGE_FRAGMENT_BIT, fragment->get())};
    VkPipelineVertexInputStateCreateInfo vertexInput{};
    vertexInput.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{};
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = 1;
    viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{};
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.lineWidth = 1.0F;
    VkPipelineMultisampleStateCreateInfo multisample{};
    multisample.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = VK_TRUE;
    depth.depthWriteEnable = VK_TRUE;
    depth.depthCompareOp = VK_COMPARE_OP_GREATER;
    VkPipelineColorBlendAttachmentState attachment{};
    attachment.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT;
    VkPipelineColorBlendStateCreateInfo blend{};
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = 1;
    blend.pAttachments = &attachment;
    constexpr VkDynamicState kDynamic[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                           VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_FRONT_FACE};
    VkPipelineDynamicStateCreateInfo dynamic{};
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = std::size(kDynamic);
    dynamic.pDynamicStates = kDynamic;
    VkPipelineRenderingCreateInfo rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachmentFormats = &kSurfaceFormat;
    rendering.depthAttachmentFormat = kDepthFormat;

    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.pNext = &rendering;
    info.stageCount = stages.size();
    info.pStages = stages.data();
    info.pVertexInputState = &vertexInput;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &multisample;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = pipelines.layout.get();
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult result = context.vk.CreateGraphicsPipelines(context.handles.device, context.pipelineCache,
                                                               1, &info, nullptr, &pipeline);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreateGraphicsPipelines", result);
    }
    pipelines.owned.emplace_back(context, pipeline);
    return pipeline;
}

bool isGraphics(const package::RoleInfo& info) {
    return info.kind == package::ShaderKind::Vertex || info.kind == package::ShaderKind::Fragment;
}

// Whether the choice runs a module that its shape has.
bool runs(const PipelineChoice& choice, const package::RoleInfo& info, const package::ModuleKey& key) {
    if (info.repeated == package::Repeated::ByOrdering) {
        return key.index == static_cast<std::uint32_t>(choice.ordering);
    }
    return key.role != ModuleRole::OrderCheck || choice.checksOrder;
}

// Every compute pass and case of the choice.
Status createComputePasses(Context::State& context, const Package& package, const PipelineChoice& choice,
                           Pipelines& pipelines) {
    // The loader gives entries that name one file the same words.
    std::map<const std::uint32_t*, VkPipeline> byWords;
    for (const package::ModuleKey& key : package::requiredModules(chosenShape(package, choice))) {
        const package::RoleInfo& info = *package::findRole(key.role);
        if (isGraphics(info) || key.tracer == package::kTracerRayPipeline || !runs(choice, info, key)) {
            continue;
        }
        const std::span<const std::uint32_t> words = package.spirv(key);
        auto known = byWords.find(words.data());
        if (known == byWords.end()) {
            Result<UniquePipeline> pipeline = createComputePipeline(context, words, pipelines.layout.get());
            if (!pipeline) {
                return pipeline.error();
            }
            known = byWords.emplace(words.data(), pipeline->get()).first;
            pipelines.owned.push_back(std::move(*pipeline));
        }
        PassPipeline pass;
        pass.pipeline = known->second;
        if (key.role == ModuleRole::ShadeCase) {
            pipelines.cases.resize(package.caseCount());
            pipelines.cases[key.index] = pass;
        } else if (key.role == ModuleRole::EffectRays) {
            pipelines.effectRays.resize(package::kEffectCount);
            pipelines.effectRays[key.index] = pass;
        } else {
            pipelines.passes[key.role] = pass;
        }
    }
    return okStatus();
}

}  // namespace

package::PackageShape chosenShape(const Package& package, const PipelineChoice& choice) {
    package::PackageShape shape = package.shape();
    shape.strategies = choice.strategy;
    shape.tracers = choice.tracer;
    shape.deforms = false;  // that pass is the scene's own
    return shape;
}

VkShaderStageFlags pushStages(const Context::State& context) {
    return VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | passStages(context);
}

Result<Pipelines> createPipelines(Context::State& context, const Package& package,
                                  const PipelineChoice& choice, std::span<const std::uint32_t> shaderIds,
                                  std::span<const VkDescriptorSetLayout> setLayouts) {
    const auto start = std::chrono::steady_clock::now();
    Pipelines pipelines(context);
    if (Status status = createLayout(context, setLayouts, pipelines); !status) {
        return status.error();
    }
    Result<VkPipeline> gbuffer = createGBuffer(context, package, pipelines);
    if (!gbuffer) {
        return gbuffer.error();
    }
    pipelines.gbuffer = *gbuffer;
    if (Status status = createComputePasses(context, package, choice, pipelines); !status) {
        return status.error();
    }
    if (Status status = createRayPasses(context, package, choice, shaderIds, pipelines); !status) {
        return status.error();
    }
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    pipelines.creationMs = elapsed.count();
    return pipelines;
}

}  // namespace glint

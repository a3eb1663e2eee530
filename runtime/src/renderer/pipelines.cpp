#include "renderer/pipelines.h"

#include "context/vulkan_error.h"
#include "package/shader_modules.h"
#include "renderer/frame_resources.h"
#include "renderer/ray_passes.h"
#include "renderer/tile_sort.h"

#include <array>
#include <chrono>
#include <cstddef>
#include <utility>

namespace glint {
namespace {

using package::ModuleRole;

Status createLayout(Context::State& context, const LayoutSource& source, Pipelines& pipelines) {
    if (source.given != VK_NULL_HANDLE) {
        pipelines.layout = source.given;
        pipelines.pushStages = source.givenPushStages;
        return okStatus();
    }
    pipelines.pushStages = pushStages(context);
    VkPushConstantRange range{};
    range.stageFlags = pipelines.pushStages;
    range.size = sizeof(gpu::PushConstants);
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = static_cast<std::uint32_t>(source.sets.size());
    info.pSetLayouts = source.sets.data();
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &range;
    const VkResult result =
        context.vk.CreatePipelineLayout(context.handles.device, &info, nullptr, &pipelines.layout);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreatePipelineLayout", result);
    }
    pipelines.ownLayout = UniquePipelineLayout(context, pipelines.layout);
    return okStatus();
}

// Shaders fetch vertices by address, so there is no vertex input. Depth is reversed. Each draw sets its front
// face.
Result<UniquePipeline> createGBuffer(Context::State& context, const Package& package, VkPipelineLayout layout,
                                     PipelineCreation& creation) {
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

    const VkPipelineCreationFeedbackCreateInfo feedback = feedbackOf(creation);
    rendering.pNext = &feedback;

    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.pNext = &rendering;
    info.flags = creation.flags;
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
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult result = context.vk.CreateGraphicsPipelines(context.handles.device, context.pipelineCache,
                                                               1, &info, nullptr, &pipeline);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreateGraphicsPipelines", result);
    }
    return UniquePipeline(context, pipeline);
}

bool isGraphics(const package::RoleInfo& info) {
    return info.kind == package::ShaderKind::Vertex || info.kind == package::ShaderKind::Fragment;
}

// Whether the choice runs a module of its shape.
bool runs(const PipelineChoice& choice, const package::RoleInfo& info, const package::ModuleKey& key) {
    if (info.repeated == package::Repeated::ByOrdering) {
        return key.index == static_cast<std::uint32_t>(choice.ordering);
    }
    if (key.role == ModuleRole::BucketOffset) {
        return choice.ordering != package::Ordering::TileSort;
    }
    return key.role != ModuleRole::OrderCheck || choice.checksOrder;
}

// The pipelines to make and the passes that use them.
struct PipelinePlan {
    std::vector<PipelineJob> jobs;
    std::vector<std::pair<package::ModuleKey, std::size_t>> computePasses;  // each with its job
    std::vector<RayPass> rayPasses;                                         // made by the last jobs
};

PipelineJob gbufferJob(Context::State& context, const Package& package, VkPipelineLayout layout) {
    const std::size_t words = package.spirv({ModuleRole::GBufferVertex}).size() +
                              package.spirv({ModuleRole::GBufferFragment}).size();
    return {"GBuffer", words, [&context, &package, layout](PipelineCreation& creation) {
                return createGBuffer(context, package, layout, creation);
            }};
}

// Plans every compute pass and case of the choice.
void planComputePasses(Context::State& context, const Package& package, const PipelineChoice& choice,
                       VkPipelineLayout layout, PipelinePlan& plan) {
    // The loader gives the same words to entries that name the same file.
    std::map<const std::uint32_t*, std::size_t> byWords;
    for (const package::ModuleKey& key : package::requiredModules(chosenShape(package, choice))) {
        const package::RoleInfo& info = *package::findRole(key.role);
        if (isGraphics(info) || key.tracer == package::kTracerRayPipeline || !runs(choice, info, key)) {
            continue;
        }
        const std::span<const std::uint32_t> words = package.spirv(key);
        const std::uint32_t threads = chosenThreads(context.limits, key, package.bucketCount());
        const auto [known, fresh] = byWords.emplace(words.data(), plan.jobs.size());
        if (fresh) {
            plan.jobs.push_back({pipelineName(package, key), words.size(),
                                 [&context, words, layout, threads](PipelineCreation& creation) {
                                     creation.threads = threads;
                                     return createComputePipeline(context, words, layout, creation);
                                 }});
        }
        plan.computePasses.emplace_back(key, known->second);
    }
}

void planRayJobs(Context::State& context, VkPipelineLayout layout, PipelinePlan& plan) {
    for (const RayPass& pass : plan.rayPasses) {
        plan.jobs.push_back(
            {pass.name, wordCount(pass.source), [&context, &pass, layout](PipelineCreation& creation) {
                 return createRayPipeline(context, layout, pass.source, creation);
             }});
    }
}

void addComputePasses(const Package& package, const PipelinePlan& plan, Pipelines& pipelines) {
    for (const auto& [key, job] : plan.computePasses) {
        PassPipeline pass;
        pass.pipeline = pipelines.owned[job].handle.get();
        if (key.role == ModuleRole::ShadeCase) {
            pipelines.cases.resize(package.caseCount());
            pipelines.cases[key.index] = pass;
        } else {
            pipelines.add(key, pass);
        }
    }
}

}  // namespace

void Pipelines::add(const package::ModuleKey& key, const PassPipeline& pass) {
    const package::Repeated repeated = package::findRole(key.role)->repeated;
    if (repeated == package::Repeated::ByEffect || repeated == package::Repeated::ByWalk) {
        effectPasses[{key.role, key.index}] = pass;
    } else {
        passes[key.role] = pass;
    }
}

package::PackageShape chosenShape(const Package& package, const PipelineChoice& choice) {
    package::PackageShape shape = package.shape();
    shape.strategies = choice.strategy;
    shape.tracers = choice.tracer;
    shape.deforms = false;  // the scene has that pass itself
    shape.maxBounces = choice.bounces;
    return shape;
}

VkShaderStageFlags pushStages(const Context::State& context) {
    return VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | passStages(context);
}

std::string pipelineName(const Package& package, const package::ModuleKey& key) {
    const package::RoleInfo& info = *package::findRole(key.role);
    std::string name(info.name);
    switch (info.repeated) {
        case package::Repeated::Once:
            return name;
        case package::Repeated::ByCase:
            return name + " " + std::string(package.string(package.cases()[key.index].name));
        case package::Repeated::ByOrdering:
            return name + " " + std::string(nameOf(static_cast<package::Ordering>(key.index)));
        case package::Repeated::ByEffect:
        case package::Repeated::ByWalk:
            for (const package::EffectInfo& effect : package.effects()) {
                if (package::effectNumber(effect.effect) == key.index) {
                    return name + " " + std::string(effect.name);
                }
            }
            break;
    }
    return name;
}

Result<Pipelines> createPipelines(Context::State& context, const Package& package,
                                  const PipelineChoice& choice, const PipelineMaking& making,
                                  std::span<const std::uint32_t> shaderIds, const LayoutSource& source) {
    const auto start = std::chrono::steady_clock::now();
    Pipelines pipelines(context);
    if (Status status = createLayout(context, source, pipelines); !status) {
        return status.error();
    }
    const VkPipelineLayout layout = pipelines.layout;
    PipelinePlan plan;
    const bool draws = package.passes() == package::Passes::Frame;
    if (draws) {
        plan.jobs.push_back(gbufferJob(context, package, layout));
    }
    planComputePasses(context, package, choice, layout, plan);
    plan.rayPasses = planRayPasses(package, choice, shaderIds);
    planRayJobs(context, layout, plan);
    pipelines.threads = pipelineThreads(making.threads, plan.jobs.size());
    pipelines.captureStatistics = making.captureStatistics;
    const VkPipelineCreateFlags flags =
        making.captureStatistics ? VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR : 0;
    Result<std::vector<MadePipeline>> made = makePipelines(plan.jobs, flags, pipelines.threads);
    if (!made) {
        return made.error();
    }
    pipelines.owned = std::move(*made);
    if (draws) {
        pipelines.gbuffer = pipelines.owned.front().handle.get();
    }
    addComputePasses(package, plan, pipelines);
    const std::size_t firstRayJob = plan.jobs.size() - plan.rayPasses.size();
    for (std::size_t i = 0; i < plan.rayPasses.size(); ++i) {
        const VkPipeline pipeline = pipelines.owned[firstRayJob + i].handle.get();
        if (Status status = addRayPass(context, package, plan.rayPasses[i], pipeline, pipelines); !status) {
            return status.error();
        }
    }
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    pipelines.creationMs = elapsed.count();
    return pipelines;
}

}  // namespace glint

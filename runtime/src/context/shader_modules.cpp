#include "context/shader_modules.h"

#include "context/vulkan_table.h"

#include <cstddef>
#include <iterator>

namespace glint {

Result<UniqueShaderModule> createShaderModule(Context::State& context, std::span<const std::uint32_t> words) {
    const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                        .codeSize = words.size_bytes(),
                                        .pCode = words.data()};
    return createHandle<UniqueShaderModule>(context, context.vk.CreateShaderModule, "vkCreateShaderModule",
                                            info);
}

std::vector<std::uint32_t> withHalfImages(std::span<const std::uint32_t> words) {
    // SPIR-V, "Physical Layout of a SPIR-V Module and Instruction", "OpTypeImage" and "Image Format".
    constexpr std::size_t kHeaderWords = 5;
    constexpr std::uint32_t kOpTypeImage = 25;
    constexpr std::uint32_t kOpFunction = 54;
    constexpr std::size_t kSampledOperand = 7;
    constexpr std::size_t kFormatOperand = 8;
    constexpr std::uint32_t kStorage = 2;
    constexpr std::uint32_t kRgba32f = 1;
    constexpr std::uint32_t kRgba16f = 2;
    std::vector<std::uint32_t> changed(words.begin(), words.end());
    for (std::size_t at = kHeaderWords; at < changed.size();) {
        const std::uint32_t operation = changed[at] & 0xFFFFU;
        const std::size_t length = changed[at] >> 16U;
        if (length == 0 || operation == kOpFunction) {
            break;  // types stand before functions
        }
        if (operation == kOpTypeImage && at + kFormatOperand < changed.size() &&
            changed[at + kSampledOperand] == kStorage && changed[at + kFormatOperand] == kRgba32f) {
            changed[at + kFormatOperand] = kRgba16f;
        }
        at += length;
    }
    return changed;
}

VkPipelineShaderStageCreateInfo stageOf(VkShaderStageFlagBits stage, VkShaderModule module) {
    VkPipelineShaderStageCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                         .stage = stage,
                                         .module = module,
                                         .pName = "main"};
    return info;
}

VkSpecializationInfo specializationOf(const ShaderConstants& constants) {
    static constexpr VkSpecializationMapEntry kEntries[] = {
        {0, offsetof(ShaderConstants, threads), sizeof(constants.threads)},
        {1, offsetof(ShaderConstants, countsLight), sizeof(constants.countsLight)},
    };
    // Without a number of threads, a shader of somebody else's keeps its own constant 0.
    const std::uint32_t first = constants.threads == 0 ? 1 : 0;
    return {static_cast<std::uint32_t>(std::size(kEntries)) - first, kEntries + first, sizeof(constants),
            &constants};
}

Result<UniquePipeline> ownPipeline(Context::State& context, const PipelineCreation& creation,
                                   const char* call, VkResult result, VkPipeline pipeline) {
    if (result != VK_SUCCESS) {
        return vulkanError(call, result);
    }
    UniquePipeline owned(context, pipeline);
    nameObject(context, VK_OBJECT_TYPE_PIPELINE, (std::uint64_t)pipeline, creation.name);  // NOLINT: pointer
    return owned;
}

Result<UniquePipeline> createComputePipeline(Context::State& context, std::span<const std::uint32_t> words,
                                             VkPipelineLayout layout, PipelineCreation& creation) {
    GLINT_TRY(auto module, creation.halfPicture ? createShaderModule(context, withHalfImages(words))
                                                : createShaderModule(context, words));
    const VkPipelineCreationFeedbackCreateInfo feedback = feedbackOf(creation, 1);
    VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                     .pNext = &feedback,
                                     .flags = creation.flags,
                                     .stage = stageOf(VK_SHADER_STAGE_COMPUTE_BIT, module.get())};
    const VkSpecializationInfo specialization = specializationOf(creation.constants);
    info.stage.pSpecializationInfo = &specialization;
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult result = context.vk.CreateComputePipelines(
        context.handles.device, context.pipelineCache, 1, &info, context.services.allocation, &pipeline);
    return ownPipeline(context, creation, "vkCreateComputePipelines", result, pipeline);
}

Result<UniquePipeline> createComputePipeline(Context::State& context, std::span<const std::uint32_t> words,
                                             VkPipelineLayout layout) {
    PipelineCreation creation;
    return createComputePipeline(context, words, layout, creation);
}

VkPipelineCreationFeedbackCreateInfo feedbackOf(PipelineCreation& creation, std::size_t stageCount) {
    creation.stageFeedbacks.resize(stageCount);
    VkPipelineCreationFeedbackCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_CREATION_FEEDBACK_CREATE_INFO,
        .pPipelineCreationFeedback = &creation.feedback,
        .pipelineStageCreationFeedbackCount = static_cast<std::uint32_t>(stageCount),
        .pPipelineStageCreationFeedbacks = creation.stageFeedbacks.data()};
    return info;
}

}  // namespace glint

// Shader modules, and pipelines that have one module.
#pragma once

#include "context/device_objects.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Makes a module from SPIR-V words. Error "vulkan-call".
Result<UniqueShaderModule> createShaderModule(Context::State& context, std::span<const std::uint32_t> words);

// Returns a module whose storage images of the format rgba32f have rgba16f instead. The format is a literal
// of their type, which they share.
std::vector<std::uint32_t> withHalfImages(std::span<const std::uint32_t> words);

// Describes a stage whose entry point is "main".
VkPipelineShaderStageCreateInfo stageOf(VkShaderStageFlagBits stage, VkShaderModule module);

// The specialisation constants of Glint's shaders, by their IDs. A shader without one of them ignores it.
struct ShaderConstants {
    std::uint32_t threads = 0;        // 0: of a compute shader's workgroup; no threads: as the shader says
    VkBool32 countsLight = VK_FALSE;  // 1: kCountsLight of hit/bindings.glsl
};
// Returns the description of `constants`, which must outlive it.
VkSpecializationInfo specializationOf(const ShaderConstants& constants);

// Settings for making a pipeline, and the driver's feedback about it.
struct PipelineCreation {
    VkPipelineCreateFlags flags = 0;
    std::string name = "pipeline";  // for debuggers
    ShaderConstants constants{};
    bool halfPicture = false;  // the shader's images of light have 16-bit floats: withHalfImages()
    VkPipelineCreationFeedback feedback{};  // without the flag VALID the driver gives none
    std::vector<VkPipelineCreationFeedback> stageFeedbacks{};
};

// Returns the pipeline that a call of Vulkan made, or its error "vulkan-call".
Result<UniquePipeline> ownPipeline(Context::State& context, const PipelineCreation& creation,
                                   const char* call, VkResult result, VkPipeline pipeline);

// Makes a compute pipeline from SPIR-V words. Error "vulkan-call".
Result<UniquePipeline> createComputePipeline(Context::State& context, std::span<const std::uint32_t> words,
                                             VkPipelineLayout layout, PipelineCreation& creation);
Result<UniquePipeline> createComputePipeline(Context::State& context, std::span<const std::uint32_t> words,
                                             VkPipelineLayout layout);

// Returns a structure for the chain of a pipeline's creation. The driver writes to `creation`, which must
// outlive the structure. It has a place for each of the pipeline's stages: Mesa's driver of Adreno (25.0)
// writes to the first without looking at their number.
VkPipelineCreationFeedbackCreateInfo feedbackOf(PipelineCreation& creation, std::size_t stageCount);

}  // namespace glint

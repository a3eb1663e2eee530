// The functions of Vulkan that the filter calls. They come from the context, so that programs without the
// Vulkan loader can link it.
#pragma once

#include <glint/context.h>
#include <glint/result.h>

#include <string>

namespace denoise {

#define DENOISE_INSTANCE_FUNCTIONS(X) \
    X(GetDeviceProcAddr)              \
    X(GetPhysicalDeviceProperties)    \
    X(GetPhysicalDeviceMemoryProperties)

#define DENOISE_DEVICE_FUNCTIONS(X) \
    X(AllocateCommandBuffers)       \
    X(AllocateDescriptorSets)       \
    X(AllocateMemory)               \
    X(BeginCommandBuffer)           \
    X(BindBufferMemory)             \
    X(BindImageMemory)              \
    X(CmdBindDescriptorSets)        \
    X(CmdBindPipeline)              \
    X(CmdCopyImageToBuffer)         \
    X(CmdDispatch)                  \
    X(CmdPipelineBarrier2)          \
    X(CmdPushConstants)             \
    X(CmdResetQueryPool)            \
    X(CmdWriteTimestamp2)           \
    X(CreateBuffer)                 \
    X(CreateCommandPool)            \
    X(CreateComputePipelines)       \
    X(CreateDescriptorPool)         \
    X(CreateDescriptorSetLayout)    \
    X(CreateImage)                  \
    X(CreateImageView)              \
    X(CreatePipelineLayout)         \
    X(CreateQueryPool)              \
    X(CreateShaderModule)           \
    X(DestroyBuffer)                \
    X(DestroyCommandPool)           \
    X(DestroyDescriptorPool)        \
    X(DestroyDescriptorSetLayout)   \
    X(DestroyImage)                 \
    X(DestroyImageView)             \
    X(DestroyPipeline)              \
    X(DestroyPipelineLayout)        \
    X(DestroyQueryPool)             \
    X(DestroyShaderModule)          \
    X(EndCommandBuffer)             \
    X(FreeMemory)                   \
    X(GetBufferMemoryRequirements)  \
    X(GetImageMemoryRequirements)   \
    X(GetQueryPoolResults)          \
    X(MapMemory)                    \
    X(QueueSubmit)                  \
    X(QueueWaitIdle)                \
    X(UpdateDescriptorSets)

struct Functions {
#define DENOISE_DECLARE(name) PFN_vk##name name = nullptr;
    DENOISE_INSTANCE_FUNCTIONS(DENOISE_DECLARE)
    DENOISE_DEVICE_FUNCTIONS(DENOISE_DECLARE)
#undef DENOISE_DECLARE
};

// Error "vulkan-function" names a function that is missing.
inline glint::Result<Functions> loadFunctions(const glint::DeviceHandles& device) {
    Functions functions;
    const auto missing = [](const char* name) {
        return glint::Diagnostic{glint::Severity::Error, "vulkan-function", "",
                                 std::string("the driver lacks ") + name, "update the driver"};
    };
#define DENOISE_LOAD(name)                                                                       \
    functions.name =                                                                             \
        reinterpret_cast<PFN_vk##name>(device.getInstanceProcAddr(device.instance, "vk" #name)); \
    if (functions.name == nullptr) {                                                             \
        return missing("vk" #name);                                                              \
    }
    DENOISE_INSTANCE_FUNCTIONS(DENOISE_LOAD)
#undef DENOISE_LOAD
#define DENOISE_LOAD(name)                                                                                   \
    functions.name = reinterpret_cast<PFN_vk##name>(functions.GetDeviceProcAddr(device.device, "vk" #name)); \
    if (functions.name == nullptr) {                                                                         \
        return missing("vk" #name);                                                                          \
    }
    DENOISE_DEVICE_FUNCTIONS(DENOISE_LOAD)
#undef DENOISE_LOAD
    return functions;
}

}  // namespace denoise

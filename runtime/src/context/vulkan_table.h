// Vulkan's functions as tables that a Context owns. There are no global pointers, so two contexts, or a
// context and the host application's own loader, never interfere.
#pragma once

#include <glint/context.h>
#include <glint/result.h>

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

// Functions that are needed before an instance exists.
#define GLINT_GLOBAL_FUNCTIONS(X)       \
    X(CreateInstance)                   \
    X(EnumerateInstanceLayerProperties) \
    X(EnumerateInstanceExtensionProperties)

#define GLINT_INSTANCE_FUNCTIONS(X)           \
    X(DestroyInstance)                        \
    X(EnumeratePhysicalDevices)               \
    X(GetPhysicalDeviceProperties)            \
    X(GetPhysicalDeviceProperties2)           \
    X(GetPhysicalDeviceFeatures2)             \
    X(GetPhysicalDeviceMemoryProperties)      \
    X(GetPhysicalDeviceQueueFamilyProperties) \
    X(GetPhysicalDeviceFormatProperties)      \
    X(EnumerateDeviceExtensionProperties)     \
    X(CreateDevice)                           \
    X(GetDeviceProcAddr)

#define GLINT_DEVICE_FUNCTIONS(X)               \
    X(DestroyDevice)                            \
    X(GetDeviceQueue)                           \
    X(DeviceWaitIdle)                           \
    X(QueueSubmit2)                             \
    X(AllocateMemory)                           \
    X(FreeMemory)                               \
    X(MapMemory)                                \
    X(CreateBuffer)                             \
    X(DestroyBuffer)                            \
    X(GetBufferMemoryRequirements)              \
    X(BindBufferMemory)                         \
    X(GetBufferDeviceAddress)                   \
    X(CreateImage)                              \
    X(DestroyImage)                             \
    X(GetImageMemoryRequirements)               \
    X(BindImageMemory)                          \
    X(CreateImageView)                          \
    X(DestroyImageView)                         \
    X(CreateSampler)                            \
    X(DestroySampler)                           \
    X(CreateDescriptorSetLayout)                \
    X(DestroyDescriptorSetLayout)               \
    X(CreateDescriptorPool)                     \
    X(DestroyDescriptorPool)                    \
    X(AllocateDescriptorSets)                   \
    X(UpdateDescriptorSets)                     \
    X(CreateShaderModule)                       \
    X(DestroyShaderModule)                      \
    X(CreatePipelineLayout)                     \
    X(DestroyPipelineLayout)                    \
    X(CreatePipelineCache)                      \
    X(DestroyPipelineCache)                     \
    X(GetPipelineCacheData)                     \
    X(MergePipelineCaches)                      \
    X(CreateComputePipelines)                   \
    X(CreateGraphicsPipelines)                  \
    X(DestroyPipeline)                          \
    X(CreateCommandPool)                        \
    X(DestroyCommandPool)                       \
    X(ResetCommandPool)                         \
    X(AllocateCommandBuffers)                   \
    X(BeginCommandBuffer)                       \
    X(EndCommandBuffer)                         \
    X(CreateFence)                              \
    X(DestroyFence)                             \
    X(ResetFences)                              \
    X(WaitForFences)                            \
    X(CreateQueryPool)                          \
    X(DestroyQueryPool)                         \
    X(ResetQueryPool)                           \
    X(GetQueryPoolResults)                      \
    X(CmdResetQueryPool)                        \
    X(CmdWriteTimestamp2)                       \
    X(CmdPipelineBarrier2)                      \
    X(CmdCopyBuffer)                            \
    X(CmdCopyBufferToImage)                     \
    X(CmdCopyImageToBuffer)                     \
    X(CmdBlitImage)                             \
    X(CmdFillBuffer)                            \
    X(CmdUpdateBuffer)                          \
    X(CmdClearColorImage)                       \
    X(CmdBindPipeline)                          \
    X(CmdBindDescriptorSets)                    \
    X(CmdPushConstants)                         \
    X(CmdDispatch)                              \
    X(CmdDispatchIndirect)                      \
    X(CmdBeginRendering)                        \
    X(CmdEndRendering)                          \
    X(CmdSetViewport)                           \
    X(CmdSetScissor)                            \
    X(CmdSetCullMode)                           \
    X(CmdSetFrontFace)                          \
    X(CmdDraw)                                  \
    X(CreateAccelerationStructureKHR)           \
    X(DestroyAccelerationStructureKHR)          \
    X(GetAccelerationStructureBuildSizesKHR)    \
    X(GetAccelerationStructureDeviceAddressKHR) \
    X(CmdBuildAccelerationStructuresKHR)        \
    X(CmdCopyAccelerationStructureKHR)          \
    X(CmdWriteAccelerationStructuresPropertiesKHR)

// Functions of VK_KHR_ray_tracing_pipeline.
#define GLINT_RAY_PIPELINE_FUNCTIONS(X)   \
    X(CreateRayTracingPipelinesKHR)       \
    X(GetRayTracingShaderGroupHandlesKHR) \
    X(CmdTraceRaysKHR)                    \
    X(CmdTraceRaysIndirectKHR)

// Functions of VK_EXT_opacity_micromap.
#define GLINT_MICROMAP_FUNCTIONS(X) \
    X(CreateMicromapEXT)            \
    X(DestroyMicromapEXT)           \
    X(GetMicromapBuildSizesEXT)     \
    X(CmdBuildMicromapsEXT)

// Functions of VK_KHR_pipeline_executable_properties.
#define GLINT_PIPELINE_STATISTICS_FUNCTIONS(X) \
    X(GetPipelineExecutablePropertiesKHR)      \
    X(GetPipelineExecutableStatisticsKHR)

namespace glint {

#define GLINT_DECLARE_FUNCTION(name) PFN_vk##name name = nullptr;

struct GlobalTable {
    PFN_vkGetInstanceProcAddr GetInstanceProcAddr = nullptr;
    GLINT_GLOBAL_FUNCTIONS(GLINT_DECLARE_FUNCTION)
};

struct InstanceTable {
    GLINT_INSTANCE_FUNCTIONS(GLINT_DECLARE_FUNCTION)
    // Null unless VK_EXT_debug_utils is enabled.
    PFN_vkCreateDebugUtilsMessengerEXT CreateDebugUtilsMessengerEXT = nullptr;
    PFN_vkDestroyDebugUtilsMessengerEXT DestroyDebugUtilsMessengerEXT = nullptr;
};

struct DeviceTable {
    GLINT_DEVICE_FUNCTIONS(GLINT_DECLARE_FUNCTION)
    // Null unless DeviceHandles::tracers has ray tracing pipelines.
    GLINT_RAY_PIPELINE_FUNCTIONS(GLINT_DECLARE_FUNCTION)
    // Null unless DeviceHandles::opacityMicromaps.
    GLINT_MICROMAP_FUNCTIONS(GLINT_DECLARE_FUNCTION)
    // Null unless DeviceHandles::pipelineStatistics.
    GLINT_PIPELINE_STATISTICS_FUNCTIONS(GLINT_DECLARE_FUNCTION)
    // Null unless DeviceHandles::debugUtils.
    PFN_vkSetDebugUtilsObjectNameEXT SetDebugUtilsObjectNameEXT = nullptr;
    PFN_vkCmdBeginDebugUtilsLabelEXT CmdBeginDebugUtilsLabelEXT = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT CmdEndDebugUtilsLabelEXT = nullptr;
};

#undef GLINT_DECLARE_FUNCTION

// The system's Vulkan loader. It is closed when its last owner is destroyed.
class VulkanLibrary {
public:
    // Error "vulkan-loader" if the system has none.
    static Result<std::shared_ptr<VulkanLibrary>> open();
    ~VulkanLibrary();
    VulkanLibrary(const VulkanLibrary&) = delete;
    VulkanLibrary& operator=(const VulkanLibrary&) = delete;

    PFN_vkGetInstanceProcAddr getInstanceProcAddr() const {
        return getInstanceProcAddr_;
    }
    // Returns a symbol that the library exports, or null.
    void* symbol(const char* name) const;

private:
    explicit VulkanLibrary(void* handle) : handle_(handle) {}
    void* handle_;
    PFN_vkGetInstanceProcAddr getInstanceProcAddr_ = nullptr;
};

// Each error ("vulkan-function") names the first function that is missing.
Result<GlobalTable> loadGlobalTable(PFN_vkGetInstanceProcAddr getInstanceProcAddr);
Result<InstanceTable> loadInstanceTable(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance);
// Also loads the functions of the extensions that the handles say are enabled. Layers hand out those of
// VK_EXT_debug_utils in any case.
Result<DeviceTable> loadDeviceTable(const InstanceTable& instance, const DeviceHandles& handles);

// Returns the outcome of a call of Vulkan. Error "vulkan-call".
inline Status statusOf(const char* call, VkResult result) {
    return result == VK_SUCCESS ? okStatus() : Status(vulkanError(call, result));
}

// Fills `list` with everything that the function `call` of Vulkan lists: ask(count, list) calls it. The
// number may change between two calls. Error "vulkan-call".
template <typename Element, typename Ask, typename Count = std::uint32_t>
Status listAll(const char* call, std::vector<Element>& list, const Ask& ask, const Element& empty = {},
               Count count = 0) {
    VkResult result = VK_INCOMPLETE;
    while (result == VK_INCOMPLETE) {
        result = ask(&count, nullptr);
        if (result == VK_SUCCESS) {
            list.assign(count, empty);
            result = ask(&count, list.data());
            list.resize(count, empty);
        }
    }
    return statusOf(call, result);
}

// Returns a name such as "VK_ERROR_DEVICE_LOST", or "VkResult -1234" for a code that this version does not
// know.
std::string vulkanResultName(VkResult result);

}  // namespace glint

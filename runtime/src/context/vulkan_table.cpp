#include "context/vulkan_table.h"

#include <dlfcn.h>
#include <string>

namespace glint {

Result<std::shared_ptr<VulkanLibrary>> VulkanLibrary::open() {
    for (const char* name : {"libvulkan.so.1", "libvulkan.so"}) {
        void* handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
        if (handle == nullptr) {
            continue;
        }
        std::shared_ptr<VulkanLibrary> library(new VulkanLibrary(handle));
        library->getInstanceProcAddr_ =
            reinterpret_cast<PFN_vkGetInstanceProcAddr>(library->symbol("vkGetInstanceProcAddr"));
        if (library->getInstanceProcAddr_ != nullptr) {
            return library;
        }
    }
    return makeError(
        "vulkan-loader", "", "there is no Vulkan loader (libvulkan.so.1) on this machine",
        "install the Vulkan loader and a driver, for instance libvulkan1 and mesa-vulkan-drivers");
}

VulkanLibrary::~VulkanLibrary() {
    dlclose(handle_);
}

void* VulkanLibrary::symbol(const char* name) const {
    return dlsym(handle_, name);
}

// Loads a function with `get(name)`, or returns the error that it is missing.
#define GLINT_LOAD(name)                                                                              \
    table.name = reinterpret_cast<PFN_vk##name>(get("vk" #name));                                     \
    if (table.name == nullptr) {                                                                      \
        return makeError("vulkan-function", "", "the Vulkan implementation has no function vk" #name, \
                         std::move(remedy));                                                          \
    }

Result<GlobalTable> loadGlobalTable(PFN_vkGetInstanceProcAddr getInstanceProcAddr) {
    std::string remedy = "install a current Vulkan loader";
    const auto get = [&](const char* name) { return getInstanceProcAddr(VK_NULL_HANDLE, name); };
    GlobalTable table;
    table.GetInstanceProcAddr = getInstanceProcAddr;
    GLINT_GLOBAL_FUNCTIONS(GLINT_LOAD)
    return table;
}

Result<InstanceTable> loadInstanceTable(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance) {
    std::string remedy = "create the instance with API version 1.3 or newer";
    const auto get = [&](const char* name) { return getInstanceProcAddr(instance, name); };
    InstanceTable table;
    GLINT_INSTANCE_FUNCTIONS(GLINT_LOAD)
    table.CreateDebugUtilsMessengerEXT =
        reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(get("vkCreateDebugUtilsMessengerEXT"));
    table.DestroyDebugUtilsMessengerEXT =
        reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(get("vkDestroyDebugUtilsMessengerEXT"));
    return table;
}

Result<DeviceTable> loadDeviceTable(const InstanceTable& instance, const DeviceHandles& handles) {
    std::string remedy = "create the device with what DeviceRequirements lists";
    const auto get = [&](const char* name) { return instance.GetDeviceProcAddr(handles.device, name); };
    DeviceTable table;
    GLINT_DEVICE_FUNCTIONS(GLINT_LOAD)
    if ((handles.tracers & package::kTracerRayPipeline) != 0) {
        GLINT_RAY_PIPELINE_FUNCTIONS(GLINT_LOAD)
    }
    if (handles.opacityMicromaps) {
        GLINT_MICROMAP_FUNCTIONS(GLINT_LOAD)
    }
    if (handles.pipelineStatistics) {
        GLINT_PIPELINE_STATISTICS_FUNCTIONS(GLINT_LOAD)
    }
    if (handles.debugUtils) {
        table.SetDebugUtilsObjectNameEXT =
            reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(get("vkSetDebugUtilsObjectNameEXT"));
        table.CmdBeginDebugUtilsLabelEXT =
            reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(get("vkCmdBeginDebugUtilsLabelEXT"));
        table.CmdEndDebugUtilsLabelEXT =
            reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(get("vkCmdEndDebugUtilsLabelEXT"));
    }
    return table;
}
#undef GLINT_LOAD

std::string vulkanResultName(VkResult result) {
    switch (result) {
#define GLINT_RESULT(name) \
    case name:             \
        return #name;
        GLINT_RESULT(VK_SUCCESS)
        GLINT_RESULT(VK_NOT_READY)
        GLINT_RESULT(VK_TIMEOUT)
        GLINT_RESULT(VK_INCOMPLETE)
        GLINT_RESULT(VK_ERROR_OUT_OF_HOST_MEMORY)
        GLINT_RESULT(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        GLINT_RESULT(VK_ERROR_INITIALIZATION_FAILED)
        GLINT_RESULT(VK_ERROR_DEVICE_LOST)
        GLINT_RESULT(VK_ERROR_MEMORY_MAP_FAILED)
        GLINT_RESULT(VK_ERROR_LAYER_NOT_PRESENT)
        GLINT_RESULT(VK_ERROR_EXTENSION_NOT_PRESENT)
        GLINT_RESULT(VK_ERROR_FEATURE_NOT_PRESENT)
        GLINT_RESULT(VK_ERROR_INCOMPATIBLE_DRIVER)
        GLINT_RESULT(VK_ERROR_TOO_MANY_OBJECTS)
        GLINT_RESULT(VK_ERROR_FORMAT_NOT_SUPPORTED)
        GLINT_RESULT(VK_ERROR_FRAGMENTED_POOL)
        GLINT_RESULT(VK_ERROR_UNKNOWN)
        GLINT_RESULT(VK_ERROR_OUT_OF_POOL_MEMORY)
        GLINT_RESULT(VK_ERROR_INVALID_EXTERNAL_HANDLE)
        GLINT_RESULT(VK_ERROR_FRAGMENTATION)
        GLINT_RESULT(VK_ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS)
        GLINT_RESULT(VK_ERROR_INVALID_SHADER_NV)
        GLINT_RESULT(VK_ERROR_SURFACE_LOST_KHR)
        GLINT_RESULT(VK_ERROR_OUT_OF_DATE_KHR)
#undef GLINT_RESULT
        default:
            return "VkResult " + std::to_string(static_cast<int>(result));
    }
}

Diagnostic vulkanError(const char* call, VkResult result) {
    Diagnostic error =
        makeError("vulkan-call", "", std::string(call) + " failed with " + vulkanResultName(result));
    error.code = result;
    constexpr const char* kSmaller = "use a smaller scene, smaller textures or a smaller image";
    switch (result) {
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            error.kind = ErrorKind::OutOfHostMemory;
            error.hint = kSmaller;
            break;
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            error.kind = ErrorKind::OutOfDeviceMemory;
            error.hint = kSmaller;
            break;
        case VK_ERROR_DEVICE_LOST:
            error.kind = ErrorKind::DeviceLost;
            error.hint = "update the driver, or try again with validation on";
            break;
        case VK_ERROR_SURFACE_LOST_KHR:
            error.kind = ErrorKind::SurfaceLost;
            break;
        default:
            break;
    }
    return error;
}

}  // namespace glint

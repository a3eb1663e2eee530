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

namespace {

Diagnostic missingFunction(const std::string& name, std::string hint) {
    return makeError("vulkan-function", "", "the Vulkan implementation has no function " + name,
                     std::move(hint));
}

}  // namespace

Result<GlobalTable> loadGlobalTable(PFN_vkGetInstanceProcAddr getInstanceProcAddr) {
    GlobalTable table;
    table.GetInstanceProcAddr = getInstanceProcAddr;
#define GLINT_LOAD(name)                                                                          \
    table.name = reinterpret_cast<PFN_vk##name>(getInstanceProcAddr(VK_NULL_HANDLE, "vk" #name)); \
    if (table.name == nullptr) {                                                                  \
        return missingFunction("vk" #name, "install a current Vulkan loader");                    \
    }
    GLINT_GLOBAL_FUNCTIONS(GLINT_LOAD)
#undef GLINT_LOAD
    return table;
}

Result<InstanceTable> loadInstanceTable(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance) {
    InstanceTable table;
#define GLINT_LOAD(name)                                                                         \
    table.name = reinterpret_cast<PFN_vk##name>(getInstanceProcAddr(instance, "vk" #name));      \
    if (table.name == nullptr) {                                                                 \
        return missingFunction("vk" #name, "create the instance with API version 1.3 or newer"); \
    }
    GLINT_INSTANCE_FUNCTIONS(GLINT_LOAD)
#undef GLINT_LOAD
    table.CreateDebugUtilsMessengerEXT = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        getInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
    table.DestroyDebugUtilsMessengerEXT = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        getInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
    return table;
}

Result<DeviceTable> loadDeviceTable(const InstanceTable& instance, VkDevice device, bool debugUtils) {
    DeviceTable table;
#define GLINT_LOAD(name)                                                                            \
    table.name = reinterpret_cast<PFN_vk##name>(instance.GetDeviceProcAddr(device, "vk" #name));    \
    if (table.name == nullptr) {                                                                    \
        return missingFunction("vk" #name, "create the device with what DeviceRequirements lists"); \
    }
    GLINT_DEVICE_FUNCTIONS(GLINT_LOAD)
#undef GLINT_LOAD
    if (debugUtils) {
        table.CmdBeginDebugUtilsLabelEXT = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(
            instance.GetDeviceProcAddr(device, "vkCmdBeginDebugUtilsLabelEXT"));
        table.CmdEndDebugUtilsLabelEXT = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(
            instance.GetDeviceProcAddr(device, "vkCmdEndDebugUtilsLabelEXT"));
    }
    return table;
}

Status loadRayPipelineFunctions(const InstanceTable& instance, VkDevice device, DeviceTable& table) {
#define GLINT_LOAD(name)                                                                            \
    table.name = reinterpret_cast<PFN_vk##name>(instance.GetDeviceProcAddr(device, "vk" #name));    \
    if (table.name == nullptr) {                                                                    \
        return missingFunction("vk" #name, "create the device with what DeviceRequirements lists"); \
    }
    GLINT_RAY_PIPELINE_FUNCTIONS(GLINT_LOAD)
#undef GLINT_LOAD
    return okStatus();
}

Status loadMicromapFunctions(const InstanceTable& instance, VkDevice device, DeviceTable& table) {
#define GLINT_LOAD(name)                                                                            \
    table.name = reinterpret_cast<PFN_vk##name>(instance.GetDeviceProcAddr(device, "vk" #name));    \
    if (table.name == nullptr) {                                                                    \
        return missingFunction("vk" #name, "create the device with what DeviceRequirements lists"); \
    }
    GLINT_MICROMAP_FUNCTIONS(GLINT_LOAD)
#undef GLINT_LOAD
    return okStatus();
}

Status loadPipelineStatisticsFunctions(const InstanceTable& instance, VkDevice device, DeviceTable& table) {
#define GLINT_LOAD(name)                                                                            \
    table.name = reinterpret_cast<PFN_vk##name>(instance.GetDeviceProcAddr(device, "vk" #name));    \
    if (table.name == nullptr) {                                                                    \
        return missingFunction("vk" #name, "create the device with what DeviceRequirements lists"); \
    }
    GLINT_PIPELINE_STATISTICS_FUNCTIONS(GLINT_LOAD)
#undef GLINT_LOAD
    return okStatus();
}

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
#undef GLINT_RESULT
        default:
            return "VkResult " + std::to_string(static_cast<int>(result));
    }
}

Diagnostic vulkanError(const char* call, VkResult result) {
    std::string hint;
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) {
        hint = "use a smaller scene, smaller textures or a smaller image";
    } else if (result == VK_ERROR_DEVICE_LOST) {
        hint = "update the driver, or try again with validation on";
    }
    return makeError("vulkan-call", "", std::string(call) + " failed with " + vulkanResultName(result),
                     std::move(hint));
}

}  // namespace glint

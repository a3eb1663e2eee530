#include "compute_device.h"

#include "context/vulkan_table.h"

#include <algorithm>
#include <vector>

namespace glint::numerics {
namespace {

// The features that probes use, as a chain.
struct Features {
    VkPhysicalDeviceFeatures2 core{};
    VkPhysicalDeviceVulkan12Features vulkan12{};
    VkPhysicalDeviceVulkan13Features vulkan13{};

    Features() {
        core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
        core.pNext = &vulkan12;
        vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
        vulkan12.pNext = &vulkan13;
        vulkan13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    }
    Features(const Features&) = delete;
    Features& operator=(const Features&) = delete;

    bool complete() const {
        return vulkan12.bufferDeviceAddress != 0 && vulkan12.scalarBlockLayout != 0 &&
               vulkan12.hostQueryReset != 0 && vulkan13.synchronization2 != 0;
    }
};

Status createInstance(const GlobalTable& table, Context::State& state) {
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "glint_numerics";
    application.apiVersion = DeviceRequirements::kApiVersion;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    const VkResult result = table.CreateInstance(&info, nullptr, &state.handles.instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        return makeError("device-missing", "", "there is no Vulkan driver on this machine", "install one");
    }
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreateInstance", result);
    }
    GLINT_TRY(auto functions, loadInstanceTable(table.GetInstanceProcAddr, state.handles.instance));
    state.instance = functions;
    state.ownsInstance = true;
    return okStatus();
}

Status chooseDevice(const std::string& wanted, Context::State& state) {
    std::uint32_t count = 0;
    state.instance.EnumeratePhysicalDevices(state.handles.instance, &count, nullptr);
    std::vector<VkPhysicalDevice> devices(count);
    const VkResult result =
        state.instance.EnumeratePhysicalDevices(state.handles.instance, &count, devices.data());
    if (result != VK_SUCCESS) {
        return vulkanError("vkEnumeratePhysicalDevices", result);
    }
    std::string names;
    for (VkPhysicalDevice device : devices) {
        VkPhysicalDeviceProperties properties{};
        state.instance.GetPhysicalDeviceProperties(device, &properties);
        names += (names.empty() ? "" : ", ") + std::string(properties.deviceName);
        if (std::string_view(properties.deviceName).find(wanted) == std::string_view::npos ||
            properties.apiVersion < DeviceRequirements::kApiVersion) {
            continue;
        }
        Features features;
        state.instance.GetPhysicalDeviceFeatures2(device, &features.core);
        if (features.complete()) {
            state.handles.physicalDevice = device;
            state.handles.shaderFloat16 = features.vulkan12.shaderFloat16 != 0;
            return okStatus();
        }
    }
    return makeError("device-features", "",
                     "no device of that name has Vulkan 1.3 and bufferDeviceAddress, scalarBlockLayout, "
                     "hostQueryReset and synchronization2",
                     "the devices are: " + (names.empty() ? "none" : names));
}

Status chooseQueueFamily(Context::State& state) {
    std::uint32_t count = 0;
    state.instance.GetPhysicalDeviceQueueFamilyProperties(state.handles.physicalDevice, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    state.instance.GetPhysicalDeviceQueueFamilyProperties(state.handles.physicalDevice, &count,
                                                          families.data());
    const auto found = std::ranges::find_if(families, [](const VkQueueFamilyProperties& family) {
        return (family.queueFlags & VK_QUEUE_COMPUTE_BIT) != 0;
    });
    if (found == families.end()) {
        return makeError("device-features", "", "the device has no queue that computes", "use another");
    }
    state.handles.queueFamily = static_cast<std::uint32_t>(found - families.begin());
    state.limits.timestampValidBits = found->timestampValidBits;
    return okStatus();
}

Status createDevice(Context::State& state) {
    Features features;
    features.vulkan12.bufferDeviceAddress = VK_TRUE;
    features.vulkan12.scalarBlockLayout = VK_TRUE;
    features.vulkan12.hostQueryReset = VK_TRUE;
    features.vulkan12.shaderFloat16 = state.handles.shaderFloat16 ? VK_TRUE : VK_FALSE;
    features.vulkan13.synchronization2 = VK_TRUE;
    const float priority = 1.0F;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = state.handles.queueFamily;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &features.core;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    const VkResult result =
        state.instance.CreateDevice(state.handles.physicalDevice, &info, nullptr, &state.handles.device);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreateDevice", result);
    }
    state.ownsDevice = true;
    // The function is null if the device lacks it, as with those of ray tracing.
#define GLINT_LOAD(name) \
    state.vk.name =      \
        reinterpret_cast<PFN_vk##name>(state.instance.GetDeviceProcAddr(state.handles.device, "vk" #name));
    GLINT_DEVICE_FUNCTIONS(GLINT_LOAD)
#undef GLINT_LOAD
    state.vk.GetDeviceQueue(state.handles.device, state.handles.queueFamily, 0, &state.handles.queue);
    return okStatus();
}

// Queries the limits that buffers and timers need.
void queryLimits(Context::State& state) {
    VkPhysicalDeviceVulkan13Properties vulkan13{};
    vulkan13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES;
    VkPhysicalDeviceVulkan12Properties vulkan12{};
    vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES;
    vulkan12.pNext = &vulkan13;
    VkPhysicalDeviceVulkan11Properties vulkan11{};
    vulkan11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES;
    vulkan11.pNext = &vulkan12;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &vulkan11;
    state.instance.GetPhysicalDeviceProperties2(state.handles.physicalDevice, &properties);
    state.limits.core = properties.properties.limits;
    state.limits.maxAllocationBytes = vulkan11.maxMemoryAllocationSize;
    state.limits.maxBufferBytes = vulkan13.maxBufferSize;
    state.limits.deviceName = properties.properties.deviceName;
    state.limits.driverName = std::string(vulkan12.driverName) + " " + vulkan12.driverInfo;
    state.instance.GetPhysicalDeviceMemoryProperties(state.handles.physicalDevice, &state.limits.memory);
}

}  // namespace

Result<std::unique_ptr<Context::State>> createComputeDevice(const std::string& deviceName) {
    auto state = std::make_unique<Context::State>();
    GLINT_TRY(auto library, VulkanLibrary::open());
    state->library = library;
    state->handles.getInstanceProcAddr = state->library->getInstanceProcAddr();
    state->handles.tracers = 0;
    GLINT_TRY(const auto table, loadGlobalTable(state->handles.getInstanceProcAddr));
    Status status = createInstance(table, *state);
    if (status) {
        status = chooseDevice(deviceName, *state);
    }
    if (status) {
        status = chooseQueueFamily(*state);
    }
    if (status) {
        status = createDevice(*state);
    }
    if (!status) {
        return status.error();
    }
    queryLimits(*state);
    return state;
}

}  // namespace glint::numerics

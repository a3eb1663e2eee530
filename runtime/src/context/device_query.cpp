// Queries the reports of physical devices.
#include "context/requirements.h"
#include "context/vulkan_error.h"

#include <algorithm>
#include <utility>

namespace glint {
namespace {

Status queryExtensions(const InstanceTable& table, VkPhysicalDevice device, DeviceReport& report) {
    std::vector<VkExtensionProperties> extensions;
    VkResult result = VK_INCOMPLETE;
    // Layers may come and go between the two calls.
    while (result == VK_INCOMPLETE) {
        std::uint32_t count = 0;
        result = table.EnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
        if (result == VK_SUCCESS) {
            extensions.resize(count);
            result = table.EnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
            extensions.resize(count);
        }
    }
    if (result != VK_SUCCESS) {
        return vulkanError("vkEnumerateDeviceExtensionProperties", result);
    }
    for (const VkExtensionProperties& extension : extensions) {
        report.extensions.emplace_back(extension.extensionName);
    }
    return okStatus();
}

// Below Vulkan 1.3 the chains of queryFeatures() are not defined, so the report then has the version only.
void queryFeatures(const InstanceTable& table, VkPhysicalDevice device, DeviceReport& report) {
    VkPhysicalDeviceVulkan11Properties subgroup{};
    subgroup.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &subgroup;
    table.GetPhysicalDeviceProperties2(device, &properties);
    report.subgroupStages = subgroup.subgroupSupportedStages;
    report.subgroupOperations = subgroup.subgroupSupportedOperations;
    const VkPhysicalDeviceLimits& limits = properties.properties.limits;
    report.maxPushConstantBytes = limits.maxPushConstantsSize;
    report.maxWorkgroupThreads =
        std::min(limits.maxComputeWorkGroupInvocations, limits.maxComputeWorkGroupSize[0]);

    table.GetPhysicalDeviceFeatures2(device, &report.features.features);
}

bool hasGraphicsQueue(const InstanceTable& table, VkPhysicalDevice device) {
    std::uint32_t count = 0;
    table.GetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    table.GetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    return std::ranges::any_of(families, [](const VkQueueFamilyProperties& family) {
        return (family.queueFlags & kNeeded) == kNeeded;
    });
}

}  // namespace

Status queryDevice(const InstanceTable& table, VkPhysicalDevice device, DeviceReport& report) {
    VkPhysicalDeviceProperties properties{};
    table.GetPhysicalDeviceProperties(device, &properties);
    report.apiVersion = properties.apiVersion;
    GLINT_TRY_DO(queryExtensions(table, device, report));
    // A device leaves structures of extensions that it lacks untouched, so the query starts from cleared
    // features.
    clearFeatures(report);
    if (report.apiVersion >= DeviceRequirements::kApiVersion) {
        queryFeatures(table, device, report);
    }
    report.hasQueue = hasGraphicsQueue(table, device);
    return okStatus();
}

namespace {

// Fills `report` through the system's loader. Returns the names of everything that this needs and the system
// lacks.
std::vector<std::string> askLoader(VkPhysicalDevice device, DeviceReport& report) {
    if (device == VK_NULL_HANDLE) {
        return {"a physical device"};
    }
    Result<std::shared_ptr<VulkanLibrary>> library = VulkanLibrary::open();
    if (!library) {
        return {"a Vulkan loader (libvulkan.so.1)"};
    }
    // The loader exports these functions for any instance, and the handle decides which driver answers.
    InstanceTable table;
#define GLINT_LOAD(name)                                                         \
    table.name = reinterpret_cast<PFN_vk##name>((*library)->symbol("vk" #name)); \
    if (table.name == nullptr) {                                                 \
        return {"vk" #name " in the Vulkan loader"};                             \
    }
    GLINT_INSTANCE_FUNCTIONS(GLINT_LOAD)
#undef GLINT_LOAD
    if (Status status = queryDevice(table, device, report); !status) {
        return {status.error().message};
    }
    return {};
}

}  // namespace

std::vector<std::string> missingRequirements(VkPhysicalDevice device) {
    DeviceReport report;
    std::vector<std::string> missing = askLoader(device, report);
    return missing.empty() ? missingFrom(report) : missing;
}

void DeviceRequirements::leaveOutLacking(VkPhysicalDevice device) {
    DeviceReport report;
    if (askLoader(device, report).empty()) {
        glint::leaveOutLacking(report, *this);
    }
}

std::uint32_t deviceTracers(VkPhysicalDevice device) {
    DeviceReport report;
    const bool complete = askLoader(device, report).empty() && missingFrom(report).empty();
    return complete ? tracersOf(report) : 0U;
}

}  // namespace glint

#include "requirements.h"

#include "interop/frame.h"
#include "vulkan_error.h"

#include <algorithm>
#include <cstring>
#include <span>

namespace glint {
namespace {

constexpr const char* kExtensions[] = {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                       VK_KHR_RAY_QUERY_EXTENSION_NAME,
                                       VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};

// A feature by name, and where its bit is in a DeviceRequirements.
struct RequiredFeature {
    const char* name;
    VkBool32& (*bit)(DeviceRequirements&);
};

#define GLINT_FEATURE(member, name)                                                                    \
    RequiredFeature {                                                                                  \
#name, [](DeviceRequirements & requirements) -> VkBool32& { return requirements.member.name; } \
    }

constexpr RequiredFeature kFeatures[] = {
    GLINT_FEATURE(features.features, shaderStorageImageExtendedFormats),
    GLINT_FEATURE(features.features, shaderSampledImageArrayDynamicIndexing),
    GLINT_FEATURE(vulkan12, bufferDeviceAddress),
    GLINT_FEATURE(vulkan12, scalarBlockLayout),
    GLINT_FEATURE(vulkan12, runtimeDescriptorArray),
    GLINT_FEATURE(vulkan12, shaderSampledImageArrayNonUniformIndexing),
    GLINT_FEATURE(vulkan12, descriptorBindingPartiallyBound),
    GLINT_FEATURE(vulkan12, descriptorBindingSampledImageUpdateAfterBind),
    GLINT_FEATURE(vulkan12, descriptorBindingVariableDescriptorCount),
    GLINT_FEATURE(vulkan12, hostQueryReset),
    GLINT_FEATURE(vulkan13, dynamicRendering),
    GLINT_FEATURE(vulkan13, synchronization2),
    GLINT_FEATURE(accelerationStructure, accelerationStructure),
    GLINT_FEATURE(rayQuery, rayQuery),
};

#undef GLINT_FEATURE

std::string versionName(std::uint32_t version) {
    return std::to_string(VK_API_VERSION_MAJOR(version)) + "." +
           std::to_string(VK_API_VERSION_MINOR(version));
}

}  // namespace

DeviceRequirements::DeviceRequirements()
    : extensions(std::begin(kExtensions), std::end(kExtensions)),
      features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &vulkan11, {}},
      vulkan11{},
      vulkan12{},
      vulkan13{},
      accelerationStructure{},
      rayQuery{} {
    vulkan11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
    vulkan11.pNext = &vulkan12;
    vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    vulkan12.pNext = &vulkan13;
    vulkan13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    vulkan13.pNext = &accelerationStructure;
    accelerationStructure.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
    accelerationStructure.pNext = &rayQuery;
    rayQuery.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
    // An umbrella bit: the specification asks for it where its parts are used with SPIR-V 1.5 modules.
    vulkan12.descriptorIndexing = VK_TRUE;
    for (const RequiredFeature& feature : kFeatures) {
        feature.bit(*this) = VK_TRUE;
    }
}

std::vector<std::string> missingFrom(const DeviceReport& report) {
    std::vector<std::string> missing;
    if (report.apiVersion < DeviceRequirements::kApiVersion) {
        missing.push_back("Vulkan " + versionName(DeviceRequirements::kApiVersion) + " (the device has " +
                          versionName(report.apiVersion) + ")");
    }
    for (const char* extension : kExtensions) {
        if (std::ranges::find(report.extensions, extension) == report.extensions.end()) {
            missing.emplace_back(extension);
        }
    }
    // The accessors take a mutable chain; nothing is written through them here.
    auto& features = const_cast<DeviceRequirements&>(report.features);
    for (const RequiredFeature& feature : kFeatures) {
        if (feature.bit(features) == VK_FALSE) {
            missing.emplace_back(feature.name);
        }
    }
    if ((report.subgroupStages & VK_SHADER_STAGE_COMPUTE_BIT) == 0) {
        missing.emplace_back("subgroup operations in compute shaders");
    }
    if ((report.subgroupOperations & VK_SUBGROUP_FEATURE_BALLOT_BIT) == 0) {
        missing.emplace_back("VK_SUBGROUP_FEATURE_BALLOT_BIT");
    }
    if ((report.subgroupOperations & VK_SUBGROUP_FEATURE_ARITHMETIC_BIT) == 0) {
        missing.emplace_back("VK_SUBGROUP_FEATURE_ARITHMETIC_BIT");
    }
    if (report.maxPushConstantBytes < sizeof(gpu::PushConstants)) {
        missing.push_back(std::to_string(sizeof(gpu::PushConstants)) + " bytes of push constants");
    }
    if (report.maxWorkgroupThreads < gpu::kScanGroupSize) {
        missing.push_back("workgroups of " + std::to_string(gpu::kScanGroupSize) + " threads");
    }
    if (!report.hasQueue) {
        missing.emplace_back("a queue family with graphics and compute");
    }
    return missing;
}

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

// Below Vulkan 1.3 the chains of queryFeatures() are not defined: the version is then all that is reported.
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

    // A structure of an extension that the device lacks is left alone by it: start from nothing.
    for (const RequiredFeature& feature : kFeatures) {
        feature.bit(report.features) = VK_FALSE;
    }
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
    if (Status status = queryExtensions(table, device, report); !status) {
        return status;
    }
    for (const RequiredFeature& feature : kFeatures) {
        feature.bit(report.features) = VK_FALSE;
    }
    if (report.apiVersion >= DeviceRequirements::kApiVersion) {
        queryFeatures(table, device, report);
    }
    report.hasQueue = hasGraphicsQueue(table, device);
    return okStatus();
}

std::vector<std::string> missingRequirements(VkPhysicalDevice device) {
    if (device == VK_NULL_HANDLE) {
        return {"a physical device"};
    }
    Result<std::shared_ptr<VulkanLibrary>> library = VulkanLibrary::open();
    if (!library) {
        return {"a Vulkan loader (libvulkan.so.1)"};
    }
    // The loader exports these functions for any instance; the handle says which driver answers.
    InstanceTable table;
#define GLINT_LOAD(name)                                                         \
    table.name = reinterpret_cast<PFN_vk##name>((*library)->symbol("vk" #name)); \
    if (table.name == nullptr) {                                                 \
        return {"vk" #name " in the Vulkan loader"};                             \
    }
    GLINT_INSTANCE_FUNCTIONS(GLINT_LOAD)
#undef GLINT_LOAD
    DeviceReport report;
    if (Status status = queryDevice(table, device, report); !status) {
        return {status.error().message};
    }
    return missingFrom(report);
}

std::string joinNames(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) {
            text += i + 1 == names.size() ? " and " : ", ";
        }
        text += names[i];
    }
    return text;
}

}  // namespace glint

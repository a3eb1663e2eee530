// Pure functions that compare the report of a device with Glint's requirements.
#pragma once

#include "context/vulkan_table.h"

#include <glint/context.h>

#include <cstdint>
#include <string>
#include <vector>

namespace glint {

// A device that supports the extension supports its feature too (Vulkan 1.3 specification, "Feature
// Requirements").
inline constexpr const char* kPositionFetchExtension = "VK_KHR_ray_tracing_position_fetch";

// The report of a physical device: features in a DeviceRequirements chain, limits and extensions.
struct DeviceReport {
    std::uint32_t apiVersion = 0;
    std::vector<std::string> extensions;
    DeviceRequirements features{package::kAllTracers};
    VkShaderStageFlags subgroupStages = 0;
    VkSubgroupFeatureFlags subgroupOperations = 0;
    std::uint32_t maxPushConstantBytes = 0;
    std::uint32_t maxWorkgroupThreads = 0;
    bool hasQueue = false;  // it has a queue family with graphics and compute
};

// Returns the names of the requirements that `report` lacks, the API version first. The list is empty if
// Glint runs on such a device.
std::vector<std::string> missingFrom(const DeviceReport& report);

// Clears the features that only some modules need and that the device lacks.
void leaveOutLacking(const DeviceReport& report, DeviceRequirements& requirements);

// Returns the features and subgroup operations that modules may use on a device, by the names of
// package::featuresOf(). Those of DeviceRequirements that the physical device has count as enabled.
std::vector<std::string> moduleFeatures(const DeviceReport& report, const DeviceHandles& handles);

// Returns the package::Tracer bits whose extensions and features `report` has in full.
std::uint32_t tracersOf(const DeviceReport& report);

bool hasExtension(const DeviceReport& report, const char* name);

// Clears every feature of `report`.
void clearFeatures(DeviceReport& report);

// Fills `report` by asking `device`. Error "vulkan-call".
Status queryDevice(const InstanceTable& table, VkPhysicalDevice device, DeviceReport& report);

// Returns a list such as "a, b and c".
std::string joinNames(const std::vector<std::string>& names);

}  // namespace glint

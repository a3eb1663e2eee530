// What a device must have, as pure functions over what it reports.
#pragma once

#include "vulkan_table.h"

#include <glint/context.h>

#include <cstdint>
#include <string>
#include <vector>

namespace glint {

// Where it is supported, so is its feature (Vulkan 1.3 specification, "Feature Requirements").
inline constexpr const char* kPositionFetchExtension = "VK_KHR_ray_tracing_position_fetch";

// What a physical device reports: features in a DeviceRequirements chain, plus limits and extensions.
struct DeviceReport {
    std::uint32_t apiVersion = 0;
    std::vector<std::string> extensions;
    DeviceRequirements features{package::kAllTracers};
    VkShaderStageFlags subgroupStages = 0;
    VkSubgroupFeatureFlags subgroupOperations = 0;
    std::uint32_t maxPushConstantBytes = 0;
    std::uint32_t maxWorkgroupThreads = 0;
    bool hasQueue = false;  // a family with graphics and compute
};

// Names of what `report` lacks, the API version first; empty if Glint runs on such a device.
std::vector<std::string> missingFrom(const DeviceReport& report);

// package::Tracer bits of which `report` has every extension and feature.
std::uint32_t tracersOf(const DeviceReport& report);

bool hasExtension(const DeviceReport& report, const char* name);

// Takes every feature out of `report`.
void clearFeatures(DeviceReport& report);

// Fills `report` by asking `device`. Error "vulkan-call".
Status queryDevice(const InstanceTable& table, VkPhysicalDevice device, DeviceReport& report);

// "a, b and c".
std::string joinNames(const std::vector<std::string>& names);

}  // namespace glint

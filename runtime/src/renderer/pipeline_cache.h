// A wrapper for a driver's pipeline cache data, which distinguishes a file of it from any other file. Drivers
// may crash on data that is damaged or of another driver, and Vulkan's own header has no checksum.
#pragma once

#include <glint/result.h>

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint {

// The device and driver that a cache belongs to.
struct PipelineCacheOwner {
    std::uint32_t vendorId = 0;
    std::uint32_t deviceId = 0;
    std::uint32_t driverId = 0;
    std::uint32_t driverVersion = 0;
    std::array<std::uint8_t, VK_UUID_SIZE> cacheUuid{};

    friend bool operator==(const PipelineCacheOwner&, const PipelineCacheOwner&) = default;
};

// Returns the owner in hexadecimal digits and hyphens.
std::string nameOf(const PipelineCacheOwner& owner);

// `data` must come from vkGetPipelineCacheData.
std::vector<std::uint8_t> wrapPipelineCache(const PipelineCacheOwner& owner,
                                            std::span<const std::uint8_t> data);

// Returns the data inside a result of wrapPipelineCache(). Error "pipeline-cache": it is damaged or has
// another owner.
Result<std::span<const std::uint8_t>> unwrapPipelineCache(const PipelineCacheOwner& owner,
                                                          std::span<const std::uint8_t> wrapped);

}  // namespace glint

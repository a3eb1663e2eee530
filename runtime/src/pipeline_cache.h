// What a driver keeps of pipelines, wrapped so that a file of it can be told from anything else: drivers may
// crash on data that is damaged or of another driver, and Vulkan's own header has no checksum.
#pragma once

#include <glint/result.h>

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Whose pipelines they are.
struct PipelineCacheOwner {
    std::uint32_t vendorId = 0;
    std::uint32_t deviceId = 0;
    std::uint32_t driverId = 0;
    std::uint32_t driverVersion = 0;
    std::array<std::uint8_t, VK_UUID_SIZE> cacheUuid{};

    friend bool operator==(const PipelineCacheOwner&, const PipelineCacheOwner&) = default;
};

// All of it in hexadecimal digits and hyphens.
std::string nameOf(const PipelineCacheOwner& owner);

// `data`: of vkGetPipelineCacheData.
std::vector<std::uint8_t> wrapPipelineCache(const PipelineCacheOwner& owner,
                                            std::span<const std::uint8_t> data);

// The data in what wrapPipelineCache() made. Error "pipeline-cache": damaged, or of another owner.
Result<std::span<const std::uint8_t>> unwrapPipelineCache(const PipelineCacheOwner& owner,
                                                          std::span<const std::uint8_t> wrapped);

}  // namespace glint

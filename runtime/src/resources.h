// Buffers and images with their memory.
#pragma once

#include "memory.h"

#include <cstdint>

namespace glint {

struct Buffer {
    UniqueBuffer handle;
    VkDeviceSize bytes = 0;
    VkDeviceAddress address = 0;
    std::uint8_t* mapped = nullptr;  // null for MemoryUse::Device
    MemoryUse use = MemoryUse::Device;
};

// A buffer of at least one byte, with a device address. `pool` must outlive it.
Result<Buffer> createBuffer(Context::State& context, MemoryPool& pool, VkDeviceSize bytes,
                            VkBufferUsageFlags usage, MemoryUse use = MemoryUse::Device);

struct DeviceImage {
    UniqueImage handle;
    UniqueImageView view;  // of all mips
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{};
    std::uint32_t mips = 1;
    VkDeviceSize bytes = 0;  // of memory
};

struct ImageInfo {
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{};
    std::uint32_t mips = 1;
    VkImageUsageFlags usage = 0;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};

// A two-dimensional image on the device, layout undefined. `pool` must outlive it.
Result<DeviceImage> createImage(Context::State& context, MemoryPool& pool, const ImageInfo& info);

// Layers 0..0 and all mips of an image.
VkImageSubresourceRange wholeImage(VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT);

}  // namespace glint

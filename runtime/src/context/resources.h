// Buffers and images that own their memory.
#pragma once

#include "context/memory.h"

#include <cstdint>

namespace glint {

struct Buffer {
    UniqueBuffer handle;
    Allocation memory;
    VkDeviceSize bytes = 0;
    VkDeviceAddress address = 0;
    std::uint8_t* mapped = nullptr;  // null for MemoryUse::Device
    MemoryUse use = MemoryUse::Device;
};

// Creates a buffer of at least one byte, with a device address. `pool` must outlive it. A buffer for which
// `shared` has room lies there, whatever `use` is.
Result<Buffer> createBuffer(Context::State& context, MemoryPool& pool, VkDeviceSize bytes,
                            VkBufferUsageFlags usage, MemoryUse use = MemoryUse::Device,
                            SharedMemory* shared = nullptr);

struct DeviceImage {
    UniqueImage handle;
    UniqueImageView view;  // view of all mips, unless it says otherwise
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{};
    std::uint32_t mips = 1;
    VkComponentMapping components{};  // of the view
    VkDeviceSize bytes = 0;           // size in memory
    Allocation memory;
};

struct ImageInfo {
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{};
    std::uint32_t mips = 1;
    VkImageUsageFlags usage = 0;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
    VkComponentMapping components{};  // of the view
};

// Creates a view of the mips from `firstMip` on.
Result<UniqueImageView> createImageView(Context::State& context, VkImage image, const ImageInfo& info,
                                        std::uint32_t firstMip);

// Creates a two-dimensional image on the device, in an undefined layout. `pool` must outlive it. With
// Tiling::Shared buffers may share its memory.
Result<DeviceImage> createImage(Context::State& context, MemoryPool& pool, const ImageInfo& info,
                                Tiling tiling = Tiling::Optimal);

// Returns the range of layer 0 and all mips of an image.
VkImageSubresourceRange wholeImage(VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT);

}  // namespace glint

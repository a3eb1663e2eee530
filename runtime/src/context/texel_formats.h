// Texel formats in Vulkan's terms.
#pragma once

#include "context/vulkan_table.h"

#include <glint/texel_format.h>

namespace glint {

// Returns VK_FORMAT_UNDEFINED if there is none: single channels, and 16 bits, are never in sRGB.
VkFormat vulkanFormat(TexelFormat format, bool srgb);

VkComponentMapping vulkanComponents(const TexelChannels& channels);

// Returns the formats besides Rgba16 that the device can sample, filter and copy to.
TexelFormats queryTexelFormats(const InstanceTable& instance, VkPhysicalDevice device);

}  // namespace glint

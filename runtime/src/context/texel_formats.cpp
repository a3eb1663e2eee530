#include "context/texel_formats.h"

#include <array>

namespace glint {
namespace {

struct FormatPair {
    VkFormat linear;
    VkFormat srgb;
};

// Indexed by TexelFormat.
constexpr std::array<FormatPair, kTexelFormatCount> kVulkanFormats{{
    {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB},
    {VK_FORMAT_R16G16B16A16_UNORM, VK_FORMAT_UNDEFINED},
    {VK_FORMAT_BC1_RGBA_UNORM_BLOCK, VK_FORMAT_BC1_RGBA_SRGB_BLOCK},
    {VK_FORMAT_BC2_UNORM_BLOCK, VK_FORMAT_BC2_SRGB_BLOCK},
    {VK_FORMAT_BC3_UNORM_BLOCK, VK_FORMAT_BC3_SRGB_BLOCK},
    {VK_FORMAT_BC4_UNORM_BLOCK, VK_FORMAT_UNDEFINED},
    {VK_FORMAT_BC5_UNORM_BLOCK, VK_FORMAT_UNDEFINED},
    {VK_FORMAT_BC7_UNORM_BLOCK, VK_FORMAT_BC7_SRGB_BLOCK},
    {VK_FORMAT_ETC2_R8G8B8_UNORM_BLOCK, VK_FORMAT_ETC2_R8G8B8_SRGB_BLOCK},
    {VK_FORMAT_ETC2_R8G8B8A1_UNORM_BLOCK, VK_FORMAT_ETC2_R8G8B8A1_SRGB_BLOCK},
    {VK_FORMAT_ETC2_R8G8B8A8_UNORM_BLOCK, VK_FORMAT_ETC2_R8G8B8A8_SRGB_BLOCK},
    {VK_FORMAT_EAC_R11_UNORM_BLOCK, VK_FORMAT_UNDEFINED},
    {VK_FORMAT_EAC_R11G11_UNORM_BLOCK, VK_FORMAT_UNDEFINED},
    {VK_FORMAT_ASTC_4x4_UNORM_BLOCK, VK_FORMAT_ASTC_4x4_SRGB_BLOCK},
    {VK_FORMAT_ASTC_5x4_UNORM_BLOCK, VK_FORMAT_ASTC_5x4_SRGB_BLOCK},
    {VK_FORMAT_ASTC_5x5_UNORM_BLOCK, VK_FORMAT_ASTC_5x5_SRGB_BLOCK},
    {VK_FORMAT_ASTC_6x5_UNORM_BLOCK, VK_FORMAT_ASTC_6x5_SRGB_BLOCK},
    {VK_FORMAT_ASTC_6x6_UNORM_BLOCK, VK_FORMAT_ASTC_6x6_SRGB_BLOCK},
    {VK_FORMAT_ASTC_8x5_UNORM_BLOCK, VK_FORMAT_ASTC_8x5_SRGB_BLOCK},
    {VK_FORMAT_ASTC_8x6_UNORM_BLOCK, VK_FORMAT_ASTC_8x6_SRGB_BLOCK},
    {VK_FORMAT_ASTC_8x8_UNORM_BLOCK, VK_FORMAT_ASTC_8x8_SRGB_BLOCK},
    {VK_FORMAT_ASTC_10x5_UNORM_BLOCK, VK_FORMAT_ASTC_10x5_SRGB_BLOCK},
    {VK_FORMAT_ASTC_10x6_UNORM_BLOCK, VK_FORMAT_ASTC_10x6_SRGB_BLOCK},
    {VK_FORMAT_ASTC_10x8_UNORM_BLOCK, VK_FORMAT_ASTC_10x8_SRGB_BLOCK},
    {VK_FORMAT_ASTC_10x10_UNORM_BLOCK, VK_FORMAT_ASTC_10x10_SRGB_BLOCK},
    {VK_FORMAT_ASTC_12x10_UNORM_BLOCK, VK_FORMAT_ASTC_12x10_SRGB_BLOCK},
    {VK_FORMAT_ASTC_12x12_UNORM_BLOCK, VK_FORMAT_ASTC_12x12_SRGB_BLOCK},
}};

VkComponentSwizzle swizzleOf(TexelChannel channel) {
    constexpr VkComponentSwizzle kSwizzles[] = {VK_COMPONENT_SWIZZLE_R,    VK_COMPONENT_SWIZZLE_G,
                                                VK_COMPONENT_SWIZZLE_B,    VK_COMPONENT_SWIZZLE_A,
                                                VK_COMPONENT_SWIZZLE_ZERO, VK_COMPONENT_SWIZZLE_ONE};
    return kSwizzles[static_cast<std::uint32_t>(channel)];
}

}  // namespace

VkFormat vulkanFormat(TexelFormat format, bool srgb) {
    const FormatPair& pair = kVulkanFormats[static_cast<std::size_t>(format)];
    return srgb ? pair.srgb : pair.linear;
}

VkComponentMapping vulkanComponents(const TexelChannels& channels) {
    return {swizzleOf(channels[0]), swizzleOf(channels[1]), swizzleOf(channels[2]), swizzleOf(channels[3])};
}

TexelFormats queryTexelFormats(const InstanceTable& instance, VkPhysicalDevice device) {
    constexpr VkFormatFeatureFlags kTexture = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT |
                                              VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT |
                                              VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
    TexelFormats formats;
    for (std::uint32_t i = 0; i < kTexelFormatCount; ++i) {
        const auto format = static_cast<TexelFormat>(i);
        for (const bool srgb : {false, true}) {
            const VkFormat vulkan = vulkanFormat(format, srgb);
            if (vulkan == VK_FORMAT_UNDEFINED || format == TexelFormat::Rgba16) {
                continue;
            }
            VkFormatProperties properties{};
            instance.GetPhysicalDeviceFormatProperties(device, vulkan, &properties);
            if ((properties.optimalTilingFeatures & kTexture) == kTexture) {
                formats.add(format, srgb);
            }
        }
    }
    return formats;
}

}  // namespace glint

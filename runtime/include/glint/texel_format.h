// The storage of an image's texels: as they are, or in blocks that GPUs read without unpacking them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace glint {

// Values are within [0, 1]. Sources of the block formats: Khronos Data Format Specification 1.3, sections 18
// (BC1 to BC5), 19 (BC7), 21 (ETC2 and EAC) and 23 (ASTC).
enum class TexelFormat : std::uint32_t {
    Rgba8,
    Rgba16,  // native byte order
    Bc1,     // RGB, and alpha of 0 or 1
    Bc2,
    Bc3,
    Bc4,  // R
    Bc5,  // RG
    Bc7,
    Etc2Rgb,
    Etc2Rgba1,  // alpha of 0 or 1
    Etc2Rgba,
    EacR,
    EacRg,
    Astc4x4,
    Astc5x4,
    Astc5x5,
    Astc6x5,
    Astc6x6,
    Astc8x5,
    Astc8x6,
    Astc8x8,
    Astc10x5,
    Astc10x6,
    Astc10x8,
    Astc10x10,
    Astc12x10,
    Astc12x12,
};

struct TexelFormatInfo {
    const char* name;
    std::uint32_t blockWidth;  // texels
    std::uint32_t blockHeight;
    std::uint32_t blockBytes;
    std::uint32_t channels;  // red first; a shader reads 0 for the other colours and 1 for alpha
    bool hasSrgb;            // there is such a format with colours in sRGB
};

// Indexed by TexelFormat.
inline constexpr TexelFormatInfo kTexelFormats[] = {
    {"RGBA8", 1, 1, 4, 4, true},         {"RGBA16", 1, 1, 8, 4, false},
    {"BC1", 4, 4, 8, 4, true},           {"BC2", 4, 4, 16, 4, true},
    {"BC3", 4, 4, 16, 4, true},          {"BC4", 4, 4, 8, 1, false},
    {"BC5", 4, 4, 16, 2, false},         {"BC7", 4, 4, 16, 4, true},
    {"ETC2 RGB", 4, 4, 8, 3, true},      {"ETC2 RGBA1", 4, 4, 8, 4, true},
    {"ETC2 RGBA", 4, 4, 16, 4, true},    {"EAC R", 4, 4, 8, 1, false},
    {"EAC RG", 4, 4, 16, 2, false},      {"ASTC 4x4", 4, 4, 16, 4, true},
    {"ASTC 5x4", 5, 4, 16, 4, true},     {"ASTC 5x5", 5, 5, 16, 4, true},
    {"ASTC 6x5", 6, 5, 16, 4, true},     {"ASTC 6x6", 6, 6, 16, 4, true},
    {"ASTC 8x5", 8, 5, 16, 4, true},     {"ASTC 8x6", 8, 6, 16, 4, true},
    {"ASTC 8x8", 8, 8, 16, 4, true},     {"ASTC 10x5", 10, 5, 16, 4, true},
    {"ASTC 10x6", 10, 6, 16, 4, true},   {"ASTC 10x8", 10, 8, 16, 4, true},
    {"ASTC 10x10", 10, 10, 16, 4, true}, {"ASTC 12x10", 12, 10, 16, 4, true},
    {"ASTC 12x12", 12, 12, 16, 4, true},
};
inline constexpr std::size_t kTexelFormatCount = std::size(kTexelFormats);
static_assert(kTexelFormatCount == static_cast<std::size_t>(TexelFormat::Astc12x12) + 1);

constexpr const TexelFormatInfo& infoOf(TexelFormat format) {
    return kTexelFormats[static_cast<std::size_t>(format)];
}
constexpr bool isBlockFormat(TexelFormat format) {
    return format != TexelFormat::Rgba8 && format != TexelFormat::Rgba16;
}

// The size of a level in texels, of one axis.
constexpr std::uint32_t sizeAtLevel(std::uint32_t size, std::uint32_t level) {
    return level < 32 ? std::max(size >> level, 1U) : 1U;
}
// The blocks of a row of texels, the last of which may be cut.
constexpr std::uint32_t blocksAcross(std::uint32_t texels, std::uint32_t blockSize) {
    return texels / blockSize + (texels % blockSize == 0 ? 0U : 1U);
}
constexpr std::uint64_t bytesOfLevel(TexelFormat format, std::uint32_t width, std::uint32_t height,
                                     std::uint32_t level) {
    const TexelFormatInfo& info = infoOf(format);
    return std::uint64_t{blocksAcross(sizeAtLevel(width, level), info.blockWidth)} *
           blocksAcross(sizeAtLevel(height, level), info.blockHeight) * info.blockBytes;
}
// Returns the bytes of the levels [0, count) together.
constexpr std::uint64_t bytesOfLevels(TexelFormat format, std::uint32_t width, std::uint32_t height,
                                      std::uint32_t count) {
    std::uint64_t bytes = 0;
    for (std::uint32_t level = 0; level < count; ++level) {
        bytes += bytesOfLevel(format, width, height, level);
    }
    return bytes;
}

// A set of formats, each as it is and with colours in sRGB.
class TexelFormats {
public:
    constexpr void add(TexelFormat format, bool srgb) {
        bits_[srgb ? 1 : 0] |= bitOf(format);
    }
    constexpr bool has(TexelFormat format, bool srgb) const {
        return (bits_[srgb ? 1 : 0] & bitOf(format)) != 0;
    }

private:
    static constexpr std::uint32_t bitOf(TexelFormat format) {
        return std::uint32_t{1} << static_cast<std::uint32_t>(format);
    }
    std::array<std::uint32_t, 2> bits_{};
};
static_assert(kTexelFormatCount <= 32);

// The value that a shader reads as a channel of an image.
enum class TexelChannel : std::uint32_t { R, G, B, A, Zero, One };
using TexelChannels = std::array<TexelChannel, 4>;
inline constexpr TexelChannels kChannelsAsStored{TexelChannel::R, TexelChannel::G, TexelChannel::B,
                                                 TexelChannel::A};

}  // namespace glint

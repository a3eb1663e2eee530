#include "gltf/texels/block_decode.h"

#include "gltf/codecs/basisu.h"
#include "gltf/texels/etc2_decode.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace glint::gltf {

namespace {

using Texel = std::array<std::uint8_t, 4>;

std::uint32_t halfWord(const std::uint8_t* bytes) {
    return static_cast<std::uint32_t>(bytes[0] | bytes[1] << 8);
}

Texel colorOf565(std::uint32_t code) {
    const std::uint32_t r = code >> 11U;
    const std::uint32_t g = code >> 5U & 63U;
    const std::uint32_t b = code & 31U;
    return {static_cast<std::uint8_t>(r << 3U | r >> 2U), static_cast<std::uint8_t>(g << 2U | g >> 4U),
            static_cast<std::uint8_t>(b << 3U | b >> 2U), 255};
}

// The mean of two colours with weights that are whole numbers.
Texel mixed(const Texel& a, const Texel& b, int ofA, int ofB) {
    Texel result{0, 0, 0, 255};
    for (std::size_t i = 0; i < 3; ++i) {
        result[i] = static_cast<std::uint8_t>((ofA * a[i] + ofB * b[i]) / (ofA + ofB));
    }
    return result;
}

// Colours of BC1, BC2 and BC3. The last two have four colours, whatever the order of the ends.
void unpackColors(const std::uint8_t* block, bool mayBeTransparent, BlockTexels& texels) {
    const std::uint32_t codes[2] = {halfWord(block), halfWord(block + 2)};
    std::array<Texel, 4> palette{colorOf565(codes[0]), colorOf565(codes[1])};
    if (codes[0] > codes[1] || !mayBeTransparent) {
        palette[2] = mixed(palette[0], palette[1], 2, 1);
        palette[3] = mixed(palette[0], palette[1], 1, 2);
    } else {
        palette[2] = mixed(palette[0], palette[1], 1, 1);
        palette[3] = {0, 0, 0, 0};
    }
    for (std::size_t i = 0; i < 16; ++i) {
        texels[i] = palette[block[4 + i / 4] >> 2 * (i % 4) & 3];
    }
}

// A channel of BC3 (alpha), BC4 and BC5.
void unpackChannel(const std::uint8_t* block, std::size_t channel, BlockTexels& texels) {
    const int a = block[0];
    const int b = block[1];
    std::array<int, 8> palette{a, b, 0, 0, 0, 0, 0, 255};
    const int steps = a > b ? 7 : 5;
    for (int i = 1; i < steps; ++i) {
        palette[static_cast<std::size_t>(i + 1)] = ((steps - i) * a + i * b + steps / 2) / steps;
    }
    std::uint64_t bits = 0;
    for (std::size_t i = 8; i-- > 2;) {
        bits = bits << 8U | block[i];
    }
    for (std::size_t i = 0; i < 16; ++i) {
        texels[i][channel] = static_cast<std::uint8_t>(palette[bits >> 3 * i & 7U]);
    }
}

// Returns false if the build lacks what the format needs. `texels` begin black and opaque.
bool unpackBlock(TexelFormat format, const std::uint8_t* block, BlockTexels& texels) {
    switch (format) {
        case TexelFormat::Bc1:
            unpackColors(block, true, texels);
            return true;
        case TexelFormat::Bc2:
            unpackColors(block + 8, false, texels);
            for (std::size_t i = 0; i < 16; ++i) {
                texels[i][3] = static_cast<std::uint8_t>((block[i / 2] >> 4 * (i % 2) & 15) * 17);
            }
            return true;
        case TexelFormat::Bc3:
            unpackColors(block + 8, false, texels);
            unpackChannel(block, 3, texels);
            return true;
        case TexelFormat::Bc5:
            unpackChannel(block + 8, 1, texels);
            [[fallthrough]];
        case TexelFormat::Bc4:
            unpackChannel(block, 0, texels);
            return true;
        case TexelFormat::Bc7:
            return unpackBc7(block, texels);
        case TexelFormat::Etc2Rgb:
            unpackEtc2(block, false, texels);
            return true;
        case TexelFormat::Etc2Rgba1:
            unpackEtc2(block, true, texels);
            return true;
        case TexelFormat::Etc2Rgba:
            unpackEtc2(block + 8, false, texels);
            unpackEac(block, false, 3, texels);
            return true;
        case TexelFormat::EacRg:
            unpackEac(block + 8, true, 1, texels);
            [[fallthrough]];
        case TexelFormat::EacR:
            unpackEac(block, true, 0, texels);
            return true;
        default:
            return false;
    }
}

// A block of the largest format.
using LargestBlock = std::array<std::uint8_t, std::size_t{4} * 12 * 12>;

bool unpackTo(TexelFormat format, bool srgb, const std::uint8_t* block, LargestBlock& unpacked) {
    const TexelFormatInfo& info = infoOf(format);
    if (format >= TexelFormat::Astc4x4) {
        return unpackAstc(block, info.blockWidth, info.blockHeight, srgb, unpacked.data());
    }
    BlockTexels texels;
    texels.fill({0, 0, 0, 255});
    if (!unpackBlock(format, block, texels)) {
        return false;
    }
    std::copy(texels.front().data(), texels.front().data() + sizeof texels, unpacked.begin());
    return true;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> decodeBlocks(TexelFormat format, bool srgb, std::uint32_t width,
                                                      std::uint32_t height, ByteView blocks,
                                                      std::string& problem) {
    const TexelFormatInfo& info = infoOf(format);
    const std::uint32_t across = blocksAcross(width, info.blockWidth);
    const std::uint32_t down = blocksAcross(height, info.blockHeight);
    std::vector<std::uint8_t> pixels(std::size_t{4} * width * height);
    LargestBlock unpacked{};
    const std::uint8_t* block = blocks.data();
    for (std::uint32_t y = 0; y < down; ++y) {
        for (std::uint32_t x = 0; x < across; ++x, block += info.blockBytes) {
            if (!unpackTo(format, srgb, block, unpacked)) {
                problem = std::string(info.name) +
                          " is unpacked by sources of Basis Universal, which this Glint was built without";
                return std::nullopt;
            }
            const std::uint32_t left = x * info.blockWidth;
            const std::uint32_t columns = std::min(info.blockWidth, width - left);
            for (std::uint32_t row = 0; row < std::min(info.blockHeight, height - y * info.blockHeight);
                 ++row) {
                const std::size_t to =
                    std::size_t{4} * ((y * info.blockHeight + row) * std::size_t{width} + left);
                std::copy_n(unpacked.begin() + std::ptrdiff_t{4} * row * info.blockWidth, 4 * columns,
                            pixels.begin() + static_cast<std::ptrdiff_t>(to));
            }
        }
    }
    return pixels;
}

}  // namespace glint::gltf

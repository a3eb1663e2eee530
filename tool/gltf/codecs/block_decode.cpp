#include "gltf/codecs/codecs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace glint::gltf {

// ---- ETC2 and EAC: Khronos Data Format Specification 1.3, section 21 ----

namespace {

using Color = std::array<int, 3>;

constexpr int kModifiers[8][2] = {{2, 8},   {5, 17},  {9, 29},   {13, 42},
                                  {18, 60}, {24, 80}, {33, 106}, {47, 183}};
constexpr int kDistances[8] = {3, 6, 11, 16, 23, 32, 41, 64};
constexpr int kEacModifiers[16][8] = {
    {-3, -6, -9, -15, 2, 5, 8, 14}, {-3, -7, -10, -13, 2, 6, 9, 12}, {-2, -5, -8, -13, 1, 4, 7, 12},
    {-2, -4, -6, -13, 1, 3, 5, 12}, {-3, -6, -8, -12, 2, 5, 7, 11},  {-3, -7, -9, -11, 2, 6, 8, 10},
    {-4, -7, -8, -11, 3, 6, 7, 10}, {-3, -5, -8, -11, 2, 4, 7, 10},  {-2, -6, -8, -10, 1, 5, 7, 9},
    {-2, -5, -8, -10, 1, 4, 7, 9},  {-2, -4, -8, -10, 1, 3, 7, 9},   {-2, -5, -7, -10, 1, 4, 6, 9},
    {-3, -4, -7, -10, 2, 3, 6, 9},  {-1, -2, -3, -10, 0, 1, 2, 9},   {-4, -6, -8, -9, 3, 5, 7, 8},
    {-3, -5, -7, -9, 2, 4, 6, 8}};

// Pixels are numbered column by column.
constexpr std::size_t placeOf(std::size_t pixel) {
    return (pixel % 4) * 4 + pixel / 4;
}

// The two bits of a pixel.
int indexOf(const std::uint8_t* block, std::size_t pixel) {
    const unsigned low = static_cast<unsigned>(block[4]) << 24U | static_cast<unsigned>(block[5]) << 16U |
                         static_cast<unsigned>(block[6]) << 8U | block[7];
    return static_cast<int>((low >> (16 + pixel) & 1U) << 1U | (low >> pixel & 1U));
}

int clamp8(int value) {
    return std::clamp(value, 0, 255);
}

Color shifted(const Color& color, int by) {
    return {color[0] + by, color[1] + by, color[2] + by};
}

void paint(BlockTexels& texels, std::size_t pixel, const Color& color, int alpha = 255) {
    auto& texel = texels[placeOf(pixel)];
    for (std::size_t i = 0; i < 3; ++i) {
        texel[i] = static_cast<std::uint8_t>(clamp8(color[i]));
    }
    texel[3] = static_cast<std::uint8_t>(alpha);
}

Color expanded(int r, int g, int b, int bits) {
    const auto expand = [bits](int value) { return value << (8 - bits) | value >> (2 * bits - 8); };
    return {expand(r), expand(g), expand(b)};
}

// The four colours of the modes T and H.
void paintPalette(const std::uint8_t* block, const std::array<Color, 4>& palette, bool transparent,
                  BlockTexels& texels) {
    for (std::size_t pixel = 0; pixel < 16; ++pixel) {
        const int index = indexOf(block, pixel);
        if (transparent && index == 2) {
            paint(texels, pixel, {0, 0, 0}, 0);
        } else {
            paint(texels, pixel, palette[static_cast<std::size_t>(index)]);
        }
    }
}

void unpackT(const std::uint8_t* block, bool transparent, BlockTexels& texels) {
    const Color first = expanded((block[0] >> 3 & 3) << 2 | (block[0] & 3), block[1] >> 4, block[1] & 15, 4);
    const Color second = expanded(block[2] >> 4, block[2] & 15, block[3] >> 4, 4);
    const int distance = kDistances[(block[3] >> 2 & 3) << 1 | (block[3] & 1)];
    paintPalette(block, {first, shifted(second, distance), second, shifted(second, -distance)}, transparent,
                 texels);
}

void unpackH(const std::uint8_t* block, bool transparent, BlockTexels& texels) {
    const Color first = expanded(block[0] >> 3 & 15, (block[0] & 7) << 1 | (block[1] >> 4 & 1),
                                 (block[1] & 8) | (block[1] & 3) << 1 | block[2] >> 7, 4);
    const Color second =
        expanded(block[2] >> 3 & 15, (block[2] & 7) << 1 | block[3] >> 7, block[3] >> 3 & 15, 4);
    const int order = first >= second ? 1 : 0;
    const int distance = kDistances[(block[3] & 4) | (block[3] & 1) << 1 | order];
    paintPalette(block,
                 {shifted(first, distance), shifted(first, -distance), shifted(second, distance),
                  shifted(second, -distance)},
                 transparent, texels);
}

void unpackPlanar(const std::uint8_t* block, BlockTexels& texels) {
    const auto six = [](int value) { return value << 2 | value >> 4; };
    const auto seven = [](int value) { return value << 1 | value >> 6; };
    const Color origin{six(block[0] >> 1 & 63), seven((block[0] & 1) << 6 | (block[1] >> 1 & 63)),
                       six((block[1] & 1) << 5 | (block[2] & 0x18) | (block[2] & 3) << 1 | block[3] >> 7)};
    const Color right{six((block[3] & 0x7C) >> 1 | (block[3] & 1)), seven(block[4] >> 1),
                      six((block[4] & 1) << 5 | block[5] >> 3)};
    const Color down{six((block[5] & 7) << 3 | block[6] >> 5), seven((block[6] & 31) << 2 | block[7] >> 6),
                     six(block[7] & 63)};
    for (std::size_t pixel = 0; pixel < 16; ++pixel) {
        const int x = static_cast<int>(pixel / 4);
        const int y = static_cast<int>(pixel % 4);
        Color color{};
        for (std::size_t i = 0; i < 3; ++i) {
            color[i] = (x * (right[i] - origin[i]) + y * (down[i] - origin[i]) + 4 * origin[i] + 2) >> 2;
        }
        paint(texels, pixel, color);
    }
}

// Two halves of the block with a base colour each.
void unpackHalves(const std::uint8_t* block, const std::array<Color, 2>& bases, bool transparent,
                  BlockTexels& texels) {
    const bool isFlipped = (block[3] & 1) != 0;
    const int tables[2] = {block[3] >> 5, block[3] >> 2 & 7};
    for (std::size_t pixel = 0; pixel < 16; ++pixel) {
        const std::size_t half = (isFlipped ? pixel % 4 : pixel / 4) / 2;
        const int* const table = kModifiers[tables[half]];
        const int index = indexOf(block, pixel);
        if (transparent && index == 2) {
            paint(texels, pixel, {0, 0, 0}, 0);
            continue;
        }
        const int size = (index & 1) != 0 ? table[1] : transparent ? 0 : table[0];
        paint(texels, pixel, shifted(bases[half], (index & 2) != 0 ? -size : size));
    }
}

// Sets red, green, blue and alpha. `punchThrough`: alpha of 0 or 1, as RGBA1 has it.
void unpackEtc2(const std::uint8_t* block, bool punchThrough, BlockTexels& texels) {
    const bool bit = (block[3] & 2) != 0;
    const bool transparent = punchThrough && !bit;
    if (!bit && !punchThrough) {
        unpackHalves(block,
                     {expanded(block[0] >> 4, block[1] >> 4, block[2] >> 4, 4),
                      expanded(block[0] & 15, block[1] & 15, block[2] & 15, 4)},
                     false, texels);
        return;
    }
    Color base{};
    Color second{};
    for (std::size_t i = 0; i < 3; ++i) {
        const int difference = (block[i] & 7) - ((block[i] & 4) << 1);
        base[i] = block[i] >> 3;
        second[i] = base[i] + difference;
    }
    // A sum that does not fit says which of the further modes the block has.
    const auto overflows = [](int value) { return value < 0 || value > 31; };
    if (overflows(second[0])) {
        unpackT(block, transparent, texels);
    } else if (overflows(second[1])) {
        unpackH(block, transparent, texels);
    } else if (overflows(second[2])) {
        unpackPlanar(block, texels);
    } else {
        unpackHalves(block,
                     {expanded(base[0], base[1], base[2], 5), expanded(second[0], second[1], second[2], 5)},
                     transparent, texels);
    }
}

// Sets one channel by a block of EAC: with 8 bits, as the alpha of RGBA has it, or with 11, rounded to 8.
void unpackEac(const std::uint8_t* block, bool has11Bits, std::size_t channel, BlockTexels& texels) {
    std::uint64_t bits = 0;
    for (std::size_t i = 2; i < 8; ++i) {
        bits = bits << 8U | block[i];
    }
    const int multiplier = block[1] >> 4;
    const int* const table = kEacModifiers[block[1] & 15];
    for (std::size_t pixel = 0; pixel < 16; ++pixel) {
        const int modifier = table[bits >> (45 - 3 * pixel) & 7U];
        int value = clamp8(block[0] + modifier * multiplier);
        if (has11Bits) {
            const int scale = multiplier == 0 ? 1 : 8 * multiplier;
            const int wide = std::clamp(8 * block[0] + 4 + modifier * scale, 0, 2047);
            value = static_cast<int>(std::lround(wide * 255.0 / 2047.0));
        }
        texels[placeOf(pixel)][channel] = static_cast<std::uint8_t>(value);
    }
}

// ---- Blocks of all formats ----

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
        palette[static_cast<std::size_t>(i) + 1] = ((steps - i) * a + i * b + steps / 2) / steps;
    }
    std::uint64_t bits = 0;
    for (std::size_t i = 8; i-- > 2;) {
        bits = bits << 8U | block[i];
    }
    for (std::size_t i = 0; i < 16; ++i) {
        texels[i][channel] = static_cast<std::uint8_t>(palette[bits >> 3 * i & 7U]);
    }
}

// `texels` begin black and opaque.
void unpackBlock(TexelFormat format, const std::uint8_t* block, BlockTexels& texels) {
    switch (format) {
        case TexelFormat::Bc1:
            unpackColors(block, true, texels);
            break;
        case TexelFormat::Bc2:
            unpackColors(block + 8, false, texels);
            for (std::size_t i = 0; i < 16; ++i) {
                texels[i][3] = static_cast<std::uint8_t>((block[i / 2] >> 4 * (i % 2) & 15) * 17);
            }
            break;
        case TexelFormat::Bc3:
            unpackColors(block + 8, false, texels);
            unpackChannel(block, 3, texels);
            break;
        case TexelFormat::Bc5:
            unpackChannel(block + 8, 1, texels);
            [[fallthrough]];
        case TexelFormat::Bc4:
            unpackChannel(block, 0, texels);
            break;
        case TexelFormat::Bc7:
            unpackBc7(block, texels);
            break;
        case TexelFormat::Etc2Rgb:
            unpackEtc2(block, false, texels);
            break;
        case TexelFormat::Etc2Rgba1:
            unpackEtc2(block, true, texels);
            break;
        case TexelFormat::Etc2Rgba:
            unpackEtc2(block + 8, false, texels);
            unpackEac(block, false, 3, texels);
            break;
        case TexelFormat::EacRg:
            unpackEac(block + 8, true, 1, texels);
            [[fallthrough]];
        case TexelFormat::EacR:
            unpackEac(block, true, 0, texels);
            break;
        default:
            break;
    }
}

// A block of the largest format.
using LargestBlock = std::array<std::uint8_t, std::size_t{4} * 12 * 12>;

void unpackTo(TexelFormat format, bool srgb, const std::uint8_t* block, LargestBlock& unpacked) {
    const TexelFormatInfo& info = infoOf(format);
    if (format >= TexelFormat::Astc4x4) {
        unpackAstc(block, info.blockWidth, info.blockHeight, srgb, unpacked.data());
        return;
    }
    BlockTexels texels;
    texels.fill({0, 0, 0, 255});
    unpackBlock(format, block, texels);
    std::copy(texels.front().data(), texels.front().data() + sizeof texels, unpacked.begin());
}

}  // namespace

Result<base::Bytes> decodeBlocks(TexelFormat format, bool srgb, std::uint32_t width, std::uint32_t height,
                                 ByteView blocks) {
    const TexelFormatInfo& info = infoOf(format);
    if ((format == TexelFormat::Bc7 || format >= TexelFormat::Astc4x4) && !hasBasisu()) {
        return imageFault(std::string(info.name) +
                          " is unpacked by sources of Basis Universal, which this Glint was built without");
    }
    const std::uint32_t across = blocksAcross(width, info.blockWidth);
    const std::uint32_t down = blocksAcross(height, info.blockHeight);
    base::Bytes pixels(std::size_t{4} * width * height);
    LargestBlock unpacked{};
    const std::uint8_t* block = blocks.data();
    for (std::uint32_t y = 0; y < down; ++y) {
        for (std::uint32_t x = 0; x < across; ++x, block += info.blockBytes) {
            unpackTo(format, srgb, block, unpacked);
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

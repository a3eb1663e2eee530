// Writes DDS and KTX2 files in block formats.
#pragma once

#include "base/files.h"

#include <glint/scene_view.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

namespace glint::test {

inline void appendWord(base::Bytes& bytes, std::uint32_t value) {
    for (std::uint32_t i = 0; i < 4; ++i) {
        bytes.push_back(static_cast<std::uint8_t>(value >> 8U * i));
    }
}

inline void setWord(base::Bytes& bytes, std::size_t offset, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) {
        bytes.at(offset + i) = static_cast<std::uint8_t>(value >> 8U * i);
    }
}

// Returns blocks of all `levels`, with bits at random.
inline base::Bytes randomBlocks(TexelFormat format, std::uint32_t width, std::uint32_t height,
                                std::uint32_t levels, std::uint32_t seed = 1) {
    std::mt19937 random(seed);
    base::Bytes blocks(static_cast<std::size_t>(bytesOfLevels(format, width, height, levels)));
    for (std::uint8_t& byte : blocks) {
        byte = static_cast<std::uint8_t>(random());
    }
    return blocks;
}

// With `dxgi` above 0 the file has a DX10 header, and otherwise the FourCC.
inline base::Bytes makeDds(std::uint32_t width, std::uint32_t height, std::uint32_t levels,
                           std::string_view fourCc, std::uint32_t dxgi, const base::Bytes& blocks) {
    base::Bytes bytes{'D', 'D', 'S', ' '};
    for (const std::uint32_t word : {124U, 0xA1007U, height, width, 0U, 0U, levels}) {
        appendWord(bytes, word);
    }
    bytes.resize(76);
    appendWord(bytes, 32);
    appendWord(bytes, 4);
    for (const char letter : dxgi > 0 ? std::string_view("DX10") : fourCc) {
        bytes.push_back(static_cast<std::uint8_t>(letter));
    }
    bytes.resize(108);
    appendWord(bytes, 0x401008);
    bytes.resize(128);
    if (dxgi > 0) {
        for (const std::uint32_t word : {dxgi, 3U, 0U, 1U, 0U}) {
            appendWord(bytes, word);
        }
    }
    bytes.insert(bytes.end(), blocks.begin(), blocks.end());
    return bytes;
}

// What a KTX2 file has beside rows and columns, as its header says it.
struct Ktx2Layers {
    std::uint32_t depth = 0;
    std::uint32_t layers = 0;
    std::uint32_t faces = 1;

    std::uint32_t atLevel(std::uint32_t level) const {
        return std::max({depth >> level, 1U}) * std::max(layers, 1U) * faces;
    }
};

// `vkFormat` is the number of the format. The levels follow each other, the largest first. Texels without
// compression may have fewer channels than the format.
inline base::Bytes makeKtx2(std::uint32_t vkFormat, TexelFormat format, std::uint32_t width,
                            std::uint32_t height, std::uint32_t levels, const base::Bytes& blocks,
                            const Ktx2Layers& layers = {}) {
    constexpr std::uint32_t kDescriptorBytes = 44;
    base::Bytes bytes{0xAB, 'K', 'T', 'X', ' ', '2', '0', 0xBB, '\r', '\n', 0x1A, '\n'};
    const std::uint32_t descriptor = 80 + 24 * levels;
    std::uint64_t place = descriptor + kDescriptorBytes;
    for (const std::uint32_t word : {vkFormat, 1U, width, height, layers.depth, layers.layers, layers.faces,
                                     levels, 0U, descriptor, kDescriptorBytes, 0U, 0U, 0U, 0U, 0U, 0U}) {
        appendWord(bytes, word);
    }
    std::uint64_t whole = 0;
    for (std::uint32_t level = 0; level < levels; ++level) {
        whole += bytesOfLevel(format, width, height, level) * layers.atLevel(level);
    }
    for (std::uint32_t level = 0; level < levels; ++level) {
        const auto size = static_cast<std::uint32_t>(bytesOfLevel(format, width, height, level) *
                                                     layers.atLevel(level) * blocks.size() / whole);
        for (const std::uint32_t word : {static_cast<std::uint32_t>(place), 0U, size, 0U, size, 0U}) {
            appendWord(bytes, word);
        }
        place += size;
    }
    appendWord(bytes, kDescriptorBytes);
    bytes.resize(descriptor + kDescriptorBytes);
    bytes.insert(bytes.end(), blocks.begin(), blocks.end());
    return bytes;
}

}  // namespace glint::test

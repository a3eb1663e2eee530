#include "gltf/codecs/block_file.h"

#include "gltf/codecs/basisu.h"
#include "gltf/codecs/codecs.h"
#include "gltf/codecs/dds.h"
#include "gltf/codecs/ktx2.h"
#include "gltf/texels/block_decode.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace glint::gltf {

std::string checkImageShape(std::uint64_t width, std::uint64_t height, std::uint64_t levels) {
    constexpr auto kLargest = static_cast<std::uint64_t>(std::numeric_limits<int>::max());
    if (width == 0 || height == 0 || width > kLargest || height > kLargest) {
        return fmt::format("its size is {} x {} pixels", width, height);
    }
    const auto most = static_cast<std::uint64_t>(std::bit_width(std::max(width, height)));
    if (levels == 0 || levels > most) {
        return fmt::format("it has {} levels; 1 to {} are possible", levels, most);
    }
    return "";
}

std::optional<BlockFile> readBlockFile(ByteView bytes, std::string& problem) {
    return findCodec(bytes) == &kDds ? readDds(bytes, problem) : readKtx2(bytes, problem);
}

std::optional<std::vector<std::uint8_t>> blocksOf(const BlockFile& file, ByteView bytes,
                                                  std::string& problem) {
    const auto width = static_cast<std::uint32_t>(file.width);
    const auto height = static_cast<std::uint32_t>(file.height);
    std::vector<std::uint8_t> blocks(static_cast<std::size_t>(
        bytesOfLevels(*file.format, width, height, static_cast<std::uint32_t>(file.levels))));
    std::span<std::uint8_t> rest(blocks);
    for (std::uint32_t level = 0; level < file.places.size(); ++level) {
        const BlockFile::Level& place = file.places[level];
        const ByteView from =
            bytes.subspan(static_cast<std::size_t>(place.offset), static_cast<std::size_t>(place.bytes));
        const std::span<std::uint8_t> to =
            rest.first(static_cast<std::size_t>(bytesOfLevel(*file.format, width, height, level)));
        if (!file.isZstandard) {
            std::ranges::copy(from, to.begin());
        } else if (!unpackZstandard(from, to)) {
            problem = fmt::format("the data of level {} are damaged", level);
            return std::nullopt;
        }
        rest = rest.subspan(to.size());
    }
    return blocks;
}

bool readBlockHeader(ByteView bytes, Image& image, std::string& problem) {
    const std::optional<BlockFile> file = readBlockFile(bytes, problem);
    if (!file) {
        return false;
    }
    image.width = file->width;
    image.height = file->height;
    image.levels = file->levels;
    image.transfer = file->transfer;
    image.storage = file->format ? Storage::Blocks : Storage::Transcoded;
    image.format = PixelFormat::Rgba8;
    return true;
}

bool decodeBlockFile(ByteView bytes, Image& image, std::string& problem) {
    const std::optional<BlockFile> file = readBlockFile(bytes, problem);
    if (!file) {
        return false;
    }
    if (!file->format) {
        return decodeBasis(bytes, image, problem);
    }
    std::optional<std::vector<std::uint8_t>> blocks = blocksOf(*file, bytes, problem);
    if (!blocks) {
        return false;
    }
    image.pixels.clear();
    std::span<const std::uint8_t> rest(*blocks);
    for (int level = 0; level < file->levels; ++level) {
        const auto width =
            sizeAtLevel(static_cast<std::uint32_t>(file->width), static_cast<std::uint32_t>(level));
        const auto height =
            sizeAtLevel(static_cast<std::uint32_t>(file->height), static_cast<std::uint32_t>(level));
        const auto bytesHere = static_cast<std::size_t>(bytesOfLevel(*file->format, width, height, 0));
        std::optional<std::vector<std::uint8_t>> pixels = decodeBlocks(
            *file->format, file->transfer == Transfer::Srgb, width, height, rest.first(bytesHere), problem);
        if (!pixels) {
            image.pixels.clear();
            return false;
        }
        for (std::size_t i = 3; !file->hasAlpha && i < pixels->size(); i += 4) {
            (*pixels)[i] = 255;
        }
        image.pixels.insert(image.pixels.end(), pixels->begin(), pixels->end());
        rest = rest.subspan(bytesHere);
    }
    return true;
}

const Codec kBasisu{"KTX2", "image/ktx2", readBlockHeader, decodeBlockFile};
const Codec kDds{"DDS", "image/vnd-ms.dds", readBlockHeader, decodeBlockFile};

}  // namespace glint::gltf

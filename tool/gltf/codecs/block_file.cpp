#include "gltf/codecs/block_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

namespace glint::gltf {

namespace {

constexpr std::uint64_t kHeaderEnd = 128;  // the magic word and DDS_HEADER
constexpr std::uint64_t kDx10End = 148;    // and DDS_HEADER_DXT10
constexpr std::uint32_t kHeaderSize = 124;
constexpr std::uint32_t kPixelFormatSize = 32;
constexpr std::uint32_t kHasFourCc = 0x4;    // DDPF_FOURCC
constexpr std::uint32_t kCubeMap = 0x200;    // DDSCAPS2_CUBEMAP
constexpr std::uint32_t kVolume = 0x200000;  // DDSCAPS2_VOLUME
constexpr std::uint32_t kTexture2d = 3;      // D3D10_RESOURCE_DIMENSION_TEXTURE2D
constexpr std::uint32_t kMiscCube = 0x4;     // D3D10_RESOURCE_MISC_TEXTURECUBE
constexpr std::uint32_t kAlphaModeBits = 7;
constexpr std::uint32_t kAlphaPremultiplied = 2;  // DDS_ALPHA_MODE_PREMULTIPLIED
constexpr const char* kPremultipliedText = "its alpha is premultiplied; it is read as if it were not";

constexpr std::uint32_t fourCc(const char (&text)[5]) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) {
        value = value << 8U | static_cast<std::uint8_t>(text[i]);
    }
    return value;
}

struct FourCcRow {
    std::uint32_t code;
    TexelFormat format;
    bool isPremultiplied;
};
constexpr auto kFourCcs = std::to_array<FourCcRow>({
    {fourCc("DXT1"), TexelFormat::Bc1, false},
    {fourCc("DXT2"), TexelFormat::Bc2, true},
    {fourCc("DXT3"), TexelFormat::Bc2, false},
    {fourCc("DXT4"), TexelFormat::Bc3, true},
    {fourCc("DXT5"), TexelFormat::Bc3, false},
    {fourCc("ATI1"), TexelFormat::Bc4, false},
    {fourCc("BC4U"), TexelFormat::Bc4, false},
    {fourCc("ATI2"), TexelFormat::Bc5, false},
    {fourCc("BC5U"), TexelFormat::Bc5, false},
});
constexpr std::uint32_t kDx10 = fourCc("DX10");

struct DxgiRow {
    std::uint32_t code;
    TexelFormat format;
    Transfer transfer;
};
constexpr auto kDxgiFormats = std::to_array<DxgiRow>({
    {70, TexelFormat::Bc1, Transfer::Unknown},
    {71, TexelFormat::Bc1, Transfer::Linear},
    {72, TexelFormat::Bc1, Transfer::Srgb},
    {73, TexelFormat::Bc2, Transfer::Unknown},
    {74, TexelFormat::Bc2, Transfer::Linear},
    {75, TexelFormat::Bc2, Transfer::Srgb},
    {76, TexelFormat::Bc3, Transfer::Unknown},
    {77, TexelFormat::Bc3, Transfer::Linear},
    {78, TexelFormat::Bc3, Transfer::Srgb},
    {79, TexelFormat::Bc4, Transfer::Unknown},
    {80, TexelFormat::Bc4, Transfer::Linear},
    {82, TexelFormat::Bc5, Transfer::Unknown},
    {83, TexelFormat::Bc5, Transfer::Linear},
    {97, TexelFormat::Bc7, Transfer::Unknown},
    {98, TexelFormat::Bc7, Transfer::Linear},
    {99, TexelFormat::Bc7, Transfer::Srgb},
});

Status readDx10(const FileReader& reader, BlockFile& file) {
    if (!reader.has(kHeaderEnd, kDx10End - kHeaderEnd)) {
        return imageFault("it ends within its header");
    }
    const std::uint32_t code = reader.word(kHeaderEnd);
    const auto* const row = std::ranges::find(kDxgiFormats, code, &DxgiRow::code);
    if (row == kDxgiFormats.end()) {
        return imageFault(
            fmt::format("it holds data of DXGI_FORMAT {}; Glint reads BC1 to BC5 and BC7, unsigned", code));
    }
    if (reader.word(kHeaderEnd + 4) != kTexture2d || (reader.word(kHeaderEnd + 8) & kMiscCube) != 0 ||
        reader.word(kHeaderEnd + 12) > 1) {
        return imageFault("it is no single two-dimensional image, but has a depth, layers or faces");
    }
    if ((reader.word(kHeaderEnd + 16) & kAlphaModeBits) == kAlphaPremultiplied) {
        file.deviations.emplace_back(kPremultipliedText);
    }
    file.format = row->format;
    file.transfer = row->transfer;
    return okStatus();
}

Status readFourCc(const FileReader& reader, BlockFile& file) {
    const std::uint32_t code = reader.word(84);
    const bool hasCode = (reader.word(80) & kHasFourCc) != 0;
    const auto* const row = std::ranges::find(kFourCcs, code, &FourCcRow::code);
    if (!hasCode || row == kFourCcs.end()) {
        return imageFault(
            hasCode
                ? fmt::format("it holds data of the FourCC 0x{:08x}; Glint reads BC1 to BC5 and BC7", code)
                : "it holds texels without block compression; Glint reads BC1 to BC5 and BC7");
    }
    if (row->isPremultiplied) {
        file.deviations.emplace_back(kPremultipliedText);
    }
    file.format = row->format;
    return okStatus();
}

Result<std::uint64_t> readHeader(const FileReader& reader, BlockFile& file) {
    if (!reader.has(0, kHeaderEnd)) {
        return imageFault("it ends within its header");
    }
    if (reader.word(4) != kHeaderSize || reader.word(76) != kPixelFormatSize) {
        return imageFault("its header is damaged");
    }
    if ((reader.word(112) & (kCubeMap | kVolume)) != 0) {
        return imageFault("it is no single two-dimensional image, but has a depth, layers or faces");
    }
    const bool isDx10 = (reader.word(80) & kHasFourCc) != 0 && reader.word(84) == kDx10;
    GLINT_TRY_DO(isDx10 ? readDx10(reader, file) : readFourCc(reader, file));
    return isDx10 ? kDx10End : kHeaderEnd;
}

// `data` is where they begin. Levels follow each other, the largest first.
Status placeLevels(const FileReader& reader, std::uint64_t data, BlockFile& file) {
    const std::uint32_t height = reader.word(12);
    const std::uint32_t width = reader.word(16);
    // Files without mips may say 0.
    const std::uint32_t levels = std::max(reader.word(28), 1U);
    GLINT_TRY_DO(checkImageShape(width, height, levels));
    file.width = static_cast<int>(width);
    file.height = static_cast<int>(height);
    file.levels = static_cast<int>(levels);
    for (std::uint32_t level = 0; level < levels; ++level) {
        const std::uint64_t bytes = bytesOfLevel(*file.format, width, height, level);
        if (!reader.has(data, bytes)) {
            return imageFault(fmt::format("it ends within its level {}", level));
        }
        file.places.push_back({data, bytes});
        data += bytes;
    }
    return okStatus();
}

}  // namespace

Result<BlockFile> readDds(ByteView bytes) {
    BlockFile file;
    const FileReader reader(bytes);
    GLINT_TRY(const auto data, readHeader(reader, file));
    GLINT_TRY_DO(placeLevels(reader, data, file));
    return file;
}

Status checkImageShape(std::uint64_t width, std::uint64_t height, std::uint64_t levels) {
    constexpr auto kLargest = static_cast<std::uint64_t>(std::numeric_limits<int>::max());
    if (width == 0 || height == 0 || width > kLargest || height > kLargest) {
        return imageFault(fmt::format("its size is {} x {} pixels", width, height));
    }
    const auto most = static_cast<std::uint64_t>(std::bit_width(std::max(width, height)));
    if (levels == 0 || levels > most) {
        return imageFault(fmt::format("it has {} levels; 1 to {} are possible", levels, most));
    }
    return okStatus();
}

}  // namespace glint::gltf

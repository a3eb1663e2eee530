// Checks the statements of DDS and KTX2 files about themselves before a decoder sees any of them.
#include "gltf/codecs/codecs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

namespace glint::gltf {

namespace {

// Reads little-endian numbers at places that were found to lie in the file.
class FileReader {
public:
    explicit FileReader(ByteView bytes) : bytes_(bytes) {}

    bool has(std::uint64_t offset, std::uint64_t length) const {
        return offset <= bytes_.size() && length <= bytes_.size() - offset;
    }
    std::uint8_t byte(std::uint64_t offset) const {
        return bytes_[static_cast<std::size_t>(offset)];
    }
    std::uint32_t word(std::uint64_t offset) const {
        return static_cast<std::uint32_t>(byte(offset) | byte(offset + 1) << 8U | byte(offset + 2) << 16U) |
               static_cast<std::uint32_t>(byte(offset + 3)) << 24U;
    }
    std::uint64_t longWord(std::uint64_t offset) const {
        return word(offset) | static_cast<std::uint64_t>(word(offset + 4)) << 32U;
    }
    std::string_view text(std::uint64_t offset, std::uint64_t length) const {
        return {reinterpret_cast<const char*>(bytes_.data()) + offset, static_cast<std::size_t>(length)};
    }

private:
    ByteView bytes_;
};

// Checks and sets the size, the layers and the number of levels of an image.
Status setShape(std::uint64_t width, std::uint64_t height, std::uint64_t layers, std::uint64_t levels,
                BlockFile& image) {
    constexpr auto kLargest = static_cast<std::uint64_t>(std::numeric_limits<int>::max());
    constexpr std::uint64_t kMostPixels = 1ULL << 56U;  // the bytes of all levels are far below 2^64
    if (width == 0 || height == 0 || width > kLargest || height > kLargest || width * height > kMostPixels) {
        return imageFault(fmt::format("its size is {} x {} pixels", width, height));
    }
    if (layers > kLargest || layers > kMostPixels / (width * height)) {
        return imageFault(fmt::format("it has {} layers or slices of {} x {} pixels", layers, width, height));
    }
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    image.layers = static_cast<int>(layers);
    const std::uint64_t depth = isVolume(image) ? layers : 1;
    const auto most = static_cast<std::uint64_t>(std::bit_width(std::max({width, height, depth})));
    if (levels == 0 || levels > most) {
        return imageFault(fmt::format("it has {} levels; 1 to {} are possible", levels, most));
    }
    image.levels = static_cast<int>(levels);
    return okStatus();
}

// ---- DDS ----

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
        return imageFault("it has a depth, layers or faces, which Glint reads in KTX2 alone");
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
        return imageFault("it has a depth, layers or faces, which Glint reads in KTX2 alone");
    }
    const bool isDx10 = (reader.word(80) & kHasFourCc) != 0 && reader.word(84) == kDx10;
    GLINT_TRY_DO(isDx10 ? readDx10(reader, file) : readFourCc(reader, file));
    return isDx10 ? kDx10End : kHeaderEnd;
}

// `data` is where they begin. Levels follow each other, the largest first.
Status placeLevels(const FileReader& reader, std::uint64_t data, BlockFile& file) {
    // Files without mips may say 0.
    GLINT_TRY_DO(setShape(reader.word(16), reader.word(12), 1, std::max(reader.word(28), 1U), file));
    for (int level = 0; level < file.levels; ++level) {
        const std::uint64_t bytes = levelBytes(file, *file.format, level);
        if (!reader.has(data, bytes)) {
            return imageFault(fmt::format("it ends within its level {}", level));
        }
        file.places.push_back({data, bytes});
        data += bytes;
    }
    return okStatus();
}

// Accepts one 2D image in BC1 to BC5 or BC7 with unsigned values: by the header's FourCC (DXT1
// to DXT5, ATI1, ATI2, BC4U, BC5U) or by a DX10 header. Source: Microsoft, "Programming Guide for DDS".
Result<BlockFile> readDds(ByteView bytes) {
    BlockFile file;
    const FileReader reader(bytes);
    GLINT_TRY(const auto data, readHeader(reader, file));
    GLINT_TRY_DO(placeLevels(reader, data, file));
    return file;
}

// ---- KTX2 ----

constexpr std::uint64_t kHeaderBytes = 80;
constexpr std::uint64_t kLevelBytes = 24;  // one entry of the level index
// Both formats have blocks of 4 x 4 pixels. A block of UASTC has 16 bytes.
constexpr std::uint64_t kBlockBytes = 16;
// The length of the basic descriptor block with one sample, and with two.
constexpr std::uint32_t kOneSample = 44;
constexpr std::uint32_t kTwoSamples = 60;
// ETC1S data begin with a header and a description of each image. The endpoints follow.
constexpr std::uint64_t kEtc1sHeaderBytes = 20;
constexpr std::uint64_t kEtc1sImageBytes = 20;

enum class Scheme : std::uint32_t { None = 0, BasisLz = 1, Zstandard = 2 };
// The colour models of the data format descriptor (khr_df.h).
enum class Model : std::uint8_t {
    Etc1s = 163,
    Uastc = 166,
    UastcHdr4x4 = 167,
    UastcHdr6x6 = 168,
    Xuastc = 169,
};
constexpr std::uint8_t kChannelRgb = 0;
constexpr std::uint8_t kChannelUastcRgba = 3;
constexpr std::uint8_t kChannelEtc1sRrr = 3;
constexpr std::uint8_t kChannelUastcRrr = 4;
constexpr std::uint8_t kChannelEtc1sAlpha = 15;
constexpr std::uint8_t kPrimariesUnspecified = 0;
constexpr std::uint8_t kPrimariesBt709 = 1;
constexpr std::uint8_t kTransferLinear = 1;
constexpr std::uint8_t kTransferSrgb = 2;
constexpr std::uint8_t kPremultiplied = 1;

// Numbers of VkFormat, which the file has. The one after it is the same in sRGB, or with signed values.
struct FormatRow {
    std::uint32_t linear;
    TexelFormat format;
};
constexpr auto kBlockFormats = std::to_array<FormatRow>({
    {131, TexelFormat::Bc1},       {133, TexelFormat::Bc1},       {135, TexelFormat::Bc2},
    {137, TexelFormat::Bc3},       {139, TexelFormat::Bc4},       {141, TexelFormat::Bc5},
    {145, TexelFormat::Bc7},       {147, TexelFormat::Etc2Rgb},   {149, TexelFormat::Etc2Rgba1},
    {151, TexelFormat::Etc2Rgba},  {153, TexelFormat::EacR},      {155, TexelFormat::EacRg},
    {157, TexelFormat::Astc4x4},   {159, TexelFormat::Astc5x4},   {161, TexelFormat::Astc5x5},
    {163, TexelFormat::Astc6x5},   {165, TexelFormat::Astc6x6},   {167, TexelFormat::Astc8x5},
    {169, TexelFormat::Astc8x6},   {171, TexelFormat::Astc8x8},   {173, TexelFormat::Astc10x5},
    {175, TexelFormat::Astc10x6},  {177, TexelFormat::Astc10x8},  {179, TexelFormat::Astc10x10},
    {181, TexelFormat::Astc12x10}, {183, TexelFormat::Astc12x12},
});

// Texels without compression. sRGB has the number of the format plus 6.
struct PlainRow {
    std::uint32_t linear;
    TexelFormat format;
    int channels;
};
constexpr auto kPlainFormats = std::to_array<PlainRow>({
    {9, TexelFormat::Rgba8, 1},
    {16, TexelFormat::Rgba8, 2},
    {23, TexelFormat::Rgba8, 3},
    {37, TexelFormat::Rgba8, 4},
    {70, TexelFormat::Rgba16, 1},
    {77, TexelFormat::Rgba16, 2},
    {84, TexelFormat::Rgba16, 3},
    {91, TexelFormat::Rgba16, 4},
});

// The fields of the header that are needed twice.
struct Header {
    Scheme scheme = Scheme::None;
    Model model = Model::Etc1s;
    bool twoSamples = false;
};

bool isFlat(const BlockFile& image) {
    return image.dimension == package::TextureEntry::Dimension::Flat;
}

// Finds the format by its number. Returns whether Glint reads it.
bool findFormat(std::uint32_t format, BlockFile& image) {
    constexpr std::uint32_t kBc1Opaque = 131;  // VK_FORMAT_BC1_RGB_UNORM_BLOCK
    // Formats of one pair follow each other: linear, then sRGB or signed values.
    for (const FormatRow& row : kBlockFormats) {
        if (format == row.linear || (format == row.linear + 1 && infoOf(row.format).hasSrgb)) {
            image.format = row.format;
            image.hasAlpha = row.linear != kBc1Opaque;
            image.transfer = format == row.linear ? Transfer::Linear : Transfer::Srgb;
        }
    }
    for (const PlainRow& row : kPlainFormats) {
        if (format == row.linear || (format == row.linear + 6 && infoOf(row.format).hasSrgb)) {
            image.format = row.format;
            image.channels = row.channels;
            image.transfer = format == row.linear ? Transfer::Linear : Transfer::Srgb;
        }
    }
    return image.format.has_value();
}

// Reads the dimension by what the file has beside rows and columns, and the size.
Status readShape(const FileReader& file, BlockFile& image) {
    using Dimension = package::TextureEntry::Dimension;
    const std::uint32_t depth = file.word(28);
    const std::uint32_t layers = file.word(32);
    const std::uint32_t faces = file.word(36);
    const bool isCube = faces == 6;
    if ((faces != 1 && !isCube) || int{depth > 0} + int{layers > 0} + int{isCube} > 1) {
        return imageFault(
            fmt::format("it has a depth of {}, {} layers and {} faces; Glint reads 2D images, arrays of "
                        "them, cubes and 3D images",
                        depth, layers, faces));
    }
    image.dimension = isCube       ? Dimension::Cube
                      : layers > 0 ? Dimension::Array
                      : depth > 0  ? Dimension::Volume
                                   : Dimension::Flat;
    GLINT_TRY_DO(
        setShape(file.word(20), file.word(24), std::max({depth, layers, faces}), file.word(40), image));
    return isCube && image.width != image.height ? imageFault("the faces of the cube are not square")
                                                 : okStatus();
}

Status readKtx2Header(const FileReader& file, Header& header, BlockFile& image) {
    const std::uint32_t format = file.word(12);
    if (format != 0 && !findFormat(format, image)) {
        return imageFault(
            fmt::format("it holds data of VkFormat {}; Glint reads ETC1S, UASTC, BC1 to BC5, BC7, ETC2, "
                        "EAC and ASTC, and 1 to 4 channels of 8 or 16 bits, with unsigned values",
                        format));
    }
    GLINT_TRY_DO(readShape(file, image));
    // The extension is about 2D textures. Other dimensions are those of packs.
    if (image.format && isFlat(image)) {
        image.deviations.push_back(
            fmt::format("it holds {}, which KHR_texture_basisu does not allow; it is read all the same",
                        infoOf(*image.format).name));
    }
    if (!image.format && isVolume(image)) {
        return imageFault("it is a 3D image of Basis Universal, which has none");
    }
    header.scheme = static_cast<Scheme>(file.word(44));
    return file.has(kHeaderBytes, kLevelBytes * static_cast<std::uint64_t>(image.levels))
               ? okStatus()
               : imageFault("it ends within its header");
}

std::string modelName(Model model) {
    switch (model) {
        case Model::UastcHdr4x4:
        case Model::UastcHdr6x6:
            return "UASTC HDR";
        case Model::Xuastc:
            return "XUASTC";
        default:
            return fmt::format("data of colour model {}", static_cast<int>(model));
    }
}

// Checks what a descriptor says besides the format: primaries and whether alpha is premultiplied.
void tellDeviations(const FileReader& file, std::uint64_t descriptor, BlockFile& image) {
    const std::uint8_t primaries = file.byte(descriptor + 13);
    if (primaries != kPrimariesUnspecified && primaries != kPrimariesBt709) {
        image.deviations.push_back(fmt::format(
            "its colour primaries have the number {}; they are taken for those of BT.709", primaries));
    }
    if ((file.byte(descriptor + 15) & kPremultiplied) != 0) {
        image.deviations.emplace_back("its alpha is premultiplied; it is read as if it were not");
    }
}

// Checks the data format descriptor of a format that VkFormat has decided.
Status checkVulkanFormat(const FileReader& file, const Header& header, BlockFile& image) {
    const std::uint64_t start = file.word(48);
    const std::uint32_t length = file.word(52);
    if (start < kHeaderBytes || !file.has(start, length) || length < kOneSample ||
        file.word(start) != length) {
        return imageFault("its data format descriptor is damaged");
    }
    if (header.scheme != Scheme::None && header.scheme != Scheme::Zstandard) {
        return imageFault(fmt::format("its supercompression scheme is {}, which Glint does not read for {}",
                                      static_cast<std::uint32_t>(header.scheme), infoOf(*image.format).name));
    }
    tellDeviations(file, start, image);
    return okStatus();
}

// Checks the data format descriptor of data of Basis Universal.
Status checkFormat(const FileReader& file, Header& header, BlockFile& image) {
    const std::uint64_t start = file.word(48);
    const std::uint32_t length = file.word(52);
    if (start < kHeaderBytes || !file.has(start, length) || (length != kOneSample && length != kTwoSamples) ||
        file.word(start) != length) {
        return imageFault("its data format descriptor is damaged");
    }
    header.model = static_cast<Model>(file.byte(start + 12));
    header.twoSamples = length == kTwoSamples;
    const bool isEtc1s = header.model == Model::Etc1s;
    if (!isEtc1s && header.model != Model::Uastc) {
        return imageFault(
            fmt::format("it holds {}, which Glint does not read; KHR_texture_basisu allows ETC1S and UASTC",
                        modelName(header.model)));
    }
    const bool schemeFits = isEtc1s ? header.scheme == Scheme::BasisLz
                                    : header.scheme == Scheme::None || header.scheme == Scheme::Zstandard;
    if (!schemeFits) {
        return imageFault(
            fmt::format("its supercompression scheme is {}, which KHR_texture_basisu does not allow for {}",
                        static_cast<std::uint32_t>(header.scheme), isEtc1s ? "ETC1S" : "UASTC"));
    }
    const auto channelOf = [&](std::uint64_t sample) {
        return static_cast<std::uint8_t>(file.byte(start + 28 + 16 * sample + 3) & 15U);
    };
    const std::uint8_t channel = channelOf(0);
    const bool isGray = channel == (isEtc1s ? kChannelEtc1sRrr : kChannelUastcRrr) && !header.twoSamples;
    const bool isColor =
        isEtc1s ? channel == kChannelRgb && (!header.twoSamples || channelOf(1) == kChannelEtc1sAlpha)
                : (channel == kChannelRgb || channel == kChannelUastcRgba) && !header.twoSamples;
    if (isGray) {
        image.deviations.emplace_back("its channels are RRR, not RGB or RGBA; it is read as gray");
    } else if (!isColor) {
        return imageFault(
            "its channels are neither RGB nor RGBA, which is all that KHR_texture_basisu allows");
    }
    const std::uint8_t transfer = file.byte(start + 14);
    if (transfer != kTransferLinear && transfer != kTransferSrgb) {
        return imageFault(fmt::format(
            "its transfer function has the number {}, which is neither linear nor sRGB", transfer));
    }
    image.transfer = transfer == kTransferSrgb ? Transfer::Srgb : Transfer::Linear;
    tellDeviations(file, start, image);
    image.hasAlpha = isEtc1s ? header.twoSamples : channel == kChannelUastcRgba;
    return okStatus();
}

// Checks the key and value data. They are pairs of text, each with its length before it, at multiples of 4
// bytes.
Status checkMetadata(const FileReader& file, BlockFile& image) {
    std::uint64_t place = file.word(56);
    const std::uint64_t length = file.word(60);
    if (length == 0) {
        return okStatus();
    }
    constexpr const char* kDamagedMetadata = "its metadata are damaged";
    if (place < kHeaderBytes || !file.has(place, length)) {
        return imageFault(kDamagedMetadata);
    }
    const std::uint64_t end = place + length;
    while (end - place > 4) {
        const std::uint64_t bytes = file.word(place);
        place += 4;
        if (bytes < 2 || bytes > end - place) {
            return imageFault(kDamagedMetadata);
        }
        const std::string_view pair = file.text(place, bytes);
        const std::size_t split = pair.find('\0');
        if (split == std::string_view::npos) {
            return imageFault(kDamagedMetadata);
        }
        const std::string_view key = pair.substr(0, split);
        std::string_view value = pair.substr(split + 1);
        value = value.substr(0, value.find('\0'));
        if (key == "KTXanimData") {
            return imageFault("it is a video");
        }
        const std::string_view orientation = isVolume(image) ? "rdi" : "rd";
        if (key == "KTXorientation" && value != orientation) {
            image.deviations.push_back(fmt::format(
                "its KTXorientation is not \"{}\"; its first row is taken to be on top all the same",
                orientation));
        }
        if (key == "KTXswizzle" && value != "rgba") {
            image.deviations.emplace_back(
                "its KTXswizzle is not \"rgba\"; its channels are read as they are");
        }
        place = std::min(end, (place + bytes + 3) / 4 * 4);
    }
    return okStatus();
}

// Checks the code books of ETC1S data, and where the data of each level lie in it.
Status checkGlobalData(const FileReader& file, const Header& header, const BlockFile& image) {
    const std::uint64_t start = file.longWord(64);
    const std::uint64_t length = file.longWord(72);
    const auto layers = static_cast<std::uint64_t>(image.layers);
    const std::uint64_t images = layers * static_cast<std::uint64_t>(image.levels);
    std::uint64_t needed = kEtc1sHeaderBytes + kEtc1sImageBytes * images;
    if (start < kHeaderBytes || !file.has(start, length) || length < needed) {
        return imageFault("its global data are damaged");
    }
    for (std::uint64_t part = 0; part < 4; ++part) {
        needed += file.word(start + 4 + 4 * part);
    }
    if (length < needed) {
        return imageFault("its global data are damaged");
    }
    for (std::uint64_t i = 0; i < images; ++i) {
        const std::uint64_t level = i / layers;
        const std::uint64_t bytesHere = file.longWord(kHeaderBytes + kLevelBytes * level + 8);
        const std::uint64_t place = start + kEtc1sHeaderBytes + kEtc1sImageBytes * i;
        // The colour comes first, then the alpha.
        for (const std::uint64_t slice : {std::uint64_t{0}, std::uint64_t{1}}) {
            const std::uint64_t offset = file.word(place + 4 + 8 * slice);
            const std::uint64_t bytes = file.word(place + 8 + 8 * slice);
            const bool isNeeded = slice == 0 || header.twoSamples;
            if (offset + bytes > bytesHere || (isNeeded && bytes == 0)) {
                return imageFault(fmt::format("its level {} is damaged", level));
            }
        }
    }
    return okStatus();
}

// Returns the bytes of a level without supercompression. A block of UASTC is as large as one of BC7.
std::uint64_t storedBytes(const BlockFile& file, int level) {
    return levelBytes(file, file.format.value_or(TexelFormat::Bc7), level) / 4 *
           static_cast<std::uint64_t>(file.channels);
}

Status checkLevels(const FileReader& file, const Header& header, BlockFile& image) {
    const auto levels = static_cast<std::uint64_t>(image.levels);
    for (std::uint64_t level = 0; level < levels; ++level) {
        const std::uint64_t entry = kHeaderBytes + kLevelBytes * level;
        const std::uint64_t start = file.longWord(entry);
        const std::uint64_t length = file.longWord(entry + 8);
        const std::uint64_t unpacked = file.longWord(entry + 16);
        const std::uint64_t wanted =
            header.scheme == Scheme::BasisLz ? 0 : storedBytes(image, static_cast<int>(level));
        if (start < kHeaderBytes + kLevelBytes * levels || !file.has(start, length) || length == 0 ||
            unpacked != wanted || (header.scheme == Scheme::None && length != wanted)) {
            return imageFault(fmt::format("its level {} is damaged", level));
        }
        // Section 3.9.7, "mipPadding", requires this. The transcoder reads blocks as structures.
        if (header.scheme == Scheme::None && !image.format && start % kBlockBytes != 0) {
            return imageFault(
                fmt::format("its level {} does not start at a multiple of {} bytes", level, kBlockBytes));
        }
        image.places.push_back({start, length});
    }
    return header.scheme == Scheme::BasisLz ? checkGlobalData(file, header, image) : okStatus();
}

// Accepts a 2D image, an array of them, a cube or a 3D image: in ETC1S (with BasisLZ) or UASTC, which
// KHR_texture_basisu wants and which have no 3D images; in BC1 to BC5, BC7, ETC2, EAC or ASTC; or in texels
// without compression. Data other than ETC1S may be compressed by Zstandard. It allocates nothing that
// depends on the file. Sources: KTX File Format Specification 2.0, sections 3 and 4; Khronos Data Format 1.3,
// section 5.
Result<BlockFile> readKtx2(ByteView bytes) {
    const FileReader file(bytes);
    // Every file has at least one level in its index.
    if (!file.has(0, kHeaderBytes + kLevelBytes) ||
        bytes.size() > std::numeric_limits<std::uint32_t>::max()) {
        return imageFault(bytes.size() < kHeaderBytes + kLevelBytes ? "it ends within its header"
                                                                    : "larger than 4 GiB");
    }
    Header header;
    BlockFile image;
    GLINT_TRY_DO(readKtx2Header(file, header, image));
    GLINT_TRY_DO(image.format ? checkVulkanFormat(file, header, image) : checkFormat(file, header, image));
    GLINT_TRY_DO(checkMetadata(file, image));
    GLINT_TRY_DO(checkLevels(file, header, image));
    image.isZstandard = header.scheme == Scheme::Zstandard;
    if (!image.format && isFlat(image) && (image.width % 4 != 0 || image.height % 4 != 0)) {
        image.deviations.emplace_back("its width and height are not multiples of 4; it is read all the same");
    }
    return image;
}

}  // namespace

Result<BlockFile> readBlockFile(ByteView bytes) {
    return findCodec(bytes) == &kDds ? readDds(bytes) : readKtx2(bytes);
}

Result<base::Bytes> blocksOf(const BlockFile& file, ByteView bytes) {
    base::Bytes blocks;
    for (int level = 0; level < file.levels; ++level) {
        const BlockFile::Level& place = file.places[static_cast<std::size_t>(level)];
        const ByteView from =
            bytes.subspan(static_cast<std::size_t>(place.offset), static_cast<std::size_t>(place.bytes));
        const std::size_t before = blocks.size();
        blocks.resize(before + static_cast<std::size_t>(storedBytes(file, level)));
        const std::span<std::uint8_t> to = std::span(blocks).subspan(before);
        if (!file.isZstandard) {
            std::ranges::copy(from, to.begin());
        } else if (!unpackZstandard(from, to)) {
            return imageFault(fmt::format("the data of level {} are damaged", level));
        }
    }
    return blocks;
}

}  // namespace glint::gltf

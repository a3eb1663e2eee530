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

// Checks the size and the number of levels of an image.
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

// Accepts one two-dimensional image in BC1 to BC5 or BC7 with unsigned values: by the header's FourCC (DXT1
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

// The fields of the header that are needed twice.
struct Header {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t levels = 0;
    Scheme scheme = Scheme::None;
    Model model = Model::Etc1s;
    bool twoSamples = false;
};

Status checkShape(const FileReader& file, Header& header, BlockFile& image) {
    const std::uint32_t format = file.word(12);
    if (format != 0) {
        const auto* const row = std::ranges::find_if(kBlockFormats, [format](const FormatRow& one) {
            return one.linear == format || one.linear + 1 == format;
        });
        // Formats of one pair follow each other: linear, then sRGB or signed values.
        if (row == kBlockFormats.end() || (format != row->linear && !infoOf(row->format).hasSrgb)) {
            return imageFault(fmt::format(
                "it holds data of VkFormat {}; Glint reads ETC1S, UASTC, and BC1 to BC5, BC7, ETC2, EAC and "
                "ASTC with unsigned values",
                format));
        }
        constexpr std::uint32_t kBc1Opaque = 131;  // VK_FORMAT_BC1_RGB_UNORM_BLOCK
        image.format = row->format;
        image.hasAlpha = row->linear != kBc1Opaque;
        image.transfer = format == row->linear ? Transfer::Linear : Transfer::Srgb;
        image.deviations.push_back(
            fmt::format("it holds {}, which KHR_texture_basisu does not allow; it is read all the same",
                        infoOf(row->format).name));
    }
    header.width = file.word(20);
    header.height = file.word(24);
    if (file.word(28) != 0 || file.word(32) != 0 || file.word(36) != 1) {
        return imageFault("it is no single two-dimensional image, but has a depth, layers or faces");
    }
    header.levels = file.word(40);
    GLINT_TRY_DO(checkImageShape(header.width, header.height, header.levels));
    header.scheme = static_cast<Scheme>(file.word(44));
    return file.has(kHeaderBytes, kLevelBytes * header.levels) ? okStatus()
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

// Checks the data format descriptor of a block format, which VkFormat has decided.
Status checkBlockFormat(const FileReader& file, const Header& header, BlockFile& image) {
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
        if (key == "KTXorientation" && value != "rd") {
            image.deviations.emplace_back(
                "its KTXorientation is not \"rd\"; its first row is taken to be on top all the same");
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
Status checkGlobalData(const FileReader& file, const Header& header) {
    const std::uint64_t start = file.longWord(64);
    const std::uint64_t length = file.longWord(72);
    std::uint64_t needed = kEtc1sHeaderBytes + kEtc1sImageBytes * header.levels;
    if (start < kHeaderBytes || !file.has(start, length) || length < needed) {
        return imageFault("its global data are damaged");
    }
    for (std::uint64_t part = 0; part < 4; ++part) {
        needed += file.word(start + 4 + 4 * part);
    }
    if (length < needed) {
        return imageFault("its global data are damaged");
    }
    for (std::uint32_t level = 0; level < header.levels; ++level) {
        const std::uint64_t levelBytes = file.longWord(kHeaderBytes + kLevelBytes * level + 8);
        const std::uint64_t place = start + kEtc1sHeaderBytes + kEtc1sImageBytes * level;
        // The colour comes first, then the alpha.
        for (const std::uint64_t slice : {std::uint64_t{0}, std::uint64_t{1}}) {
            const std::uint64_t offset = file.word(place + 4 + 8 * slice);
            const std::uint64_t bytes = file.word(place + 8 + 8 * slice);
            const bool isNeeded = slice == 0 || header.twoSamples;
            if (offset + bytes > levelBytes || (isNeeded && bytes == 0)) {
                return imageFault(fmt::format("its level {} is damaged", level));
            }
        }
    }
    return okStatus();
}

Status checkLevels(const FileReader& file, const Header& header, BlockFile& image) {
    // A block of UASTC is as large as one of BC7.
    const TexelFormat format = image.format.value_or(TexelFormat::Bc7);
    for (std::uint32_t level = 0; level < header.levels; ++level) {
        const std::uint64_t entry = kHeaderBytes + kLevelBytes * level;
        const std::uint64_t start = file.longWord(entry);
        const std::uint64_t length = file.longWord(entry + 8);
        const std::uint64_t unpacked = file.longWord(entry + 16);
        const std::uint64_t wanted =
            header.scheme == Scheme::BasisLz ? 0 : bytesOfLevel(format, header.width, header.height, level);
        if (start < kHeaderBytes + kLevelBytes * header.levels || !file.has(start, length) || length == 0 ||
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
    return header.scheme == Scheme::BasisLz ? checkGlobalData(file, header) : okStatus();
}

// Accepts one two-dimensional image: in ETC1S (with BasisLZ) or UASTC, as KHR_texture_basisu wants it, or in
// BC1 to BC5, BC7, ETC2, EAC or ASTC, which is a deviation. Data other than ETC1S may be compressed by
// Zstandard. It allocates nothing that depends on the file. Sources: KTX File Format Specification 2.0,
// sections 3 and 4; Khronos Data Format 1.3, section 5.
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
    GLINT_TRY_DO(checkShape(file, header, image));
    GLINT_TRY_DO(image.format ? checkBlockFormat(file, header, image) : checkFormat(file, header, image));
    GLINT_TRY_DO(checkMetadata(file, image));
    GLINT_TRY_DO(checkLevels(file, header, image));
    image.width = static_cast<int>(header.width);
    image.height = static_cast<int>(header.height);
    image.levels = static_cast<int>(header.levels);
    image.isZstandard = header.scheme == Scheme::Zstandard;
    if (!image.format && (image.width % 4 != 0 || image.height % 4 != 0)) {
        image.deviations.emplace_back("its width and height are not multiples of 4; it is read all the same");
    }
    return image;
}

}  // namespace

Result<BlockFile> readBlockFile(ByteView bytes) {
    return findCodec(bytes) == &kDds ? readDds(bytes) : readKtx2(bytes);
}

Result<base::Bytes> blocksOf(const BlockFile& file, ByteView bytes) {
    const auto width = static_cast<std::uint32_t>(file.width);
    const auto height = static_cast<std::uint32_t>(file.height);
    base::Bytes blocks(static_cast<std::size_t>(
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
            return imageFault(fmt::format("the data of level {} are damaged", level));
        }
        rest = rest.subspan(to.size());
    }
    return blocks;
}

}  // namespace glint::gltf

// Checks the statements of a KTX2 file about itself before a decoder sees any of it.
#include "gltf/codecs/block_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

namespace glint::gltf {

namespace {

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
    image.isEtc1s = isEtc1s;
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
    constexpr const char* kDamaged = "its metadata are damaged";
    if (place < kHeaderBytes || !file.has(place, length)) {
        return imageFault(kDamaged);
    }
    const std::uint64_t end = place + length;
    while (end - place > 4) {
        const std::uint64_t bytes = file.word(place);
        place += 4;
        if (bytes < 2 || bytes > end - place) {
            return imageFault(kDamaged);
        }
        const std::string_view pair = file.text(place, bytes);
        const std::size_t split = pair.find('\0');
        if (split == std::string_view::npos) {
            return imageFault(kDamaged);
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

}  // namespace

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

}  // namespace glint::gltf

#include "gltf/codecs/ktx2.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
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

// Reads little-endian numbers at places that were found to lie in the file.
class Ktx2Reader {
public:
    explicit Ktx2Reader(ByteView bytes) : bytes_(bytes) {}

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

// The fields of the header that are needed twice.
struct Header {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t levels = 0;
    Scheme scheme = Scheme::None;
    Model model = Model::Etc1s;
    bool twoSamples = false;
};

// Each of these functions returns what is wrong, or an empty text.

std::string checkShape(const Ktx2Reader& file, Header& header) {
    const std::uint32_t format = file.word(12);
    if (format != 0) {
        return fmt::format(
            "it holds data of VkFormat {}; KHR_texture_basisu allows ETC1S and UASTC, and "
            "neither uncompressed data nor other block compression",
            format);
    }
    header.width = file.word(20);
    header.height = file.word(24);
    if (file.word(28) != 0 || file.word(32) != 0 || file.word(36) != 1) {
        return "it is no single two-dimensional image, but has a depth, layers or faces";
    }
    constexpr auto kLargest = static_cast<std::uint32_t>(std::numeric_limits<int>::max());
    if (header.width == 0 || header.height == 0 || header.width > kLargest || header.height > kLargest) {
        return fmt::format("its size is {} x {} pixels", header.width, header.height);
    }
    header.levels = file.word(40);
    const auto most = static_cast<std::uint32_t>(std::bit_width(std::max(header.width, header.height)));
    if (header.levels == 0 || header.levels > most) {
        return fmt::format("it has {} levels; 1 to {} are possible", header.levels, most);
    }
    header.scheme = static_cast<Scheme>(file.word(44));
    return file.has(kHeaderBytes, kLevelBytes * header.levels) ? "" : "it ends within its header";
}

std::string nameOf(Model model) {
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

// Checks the data format descriptor.
std::string checkFormat(const Ktx2Reader& file, Header& header, Ktx2& image) {
    const std::uint64_t start = file.word(48);
    const std::uint32_t length = file.word(52);
    if (start < kHeaderBytes || !file.has(start, length) || (length != kOneSample && length != kTwoSamples) ||
        file.word(start) != length) {
        return "its data format descriptor is damaged";
    }
    header.model = static_cast<Model>(file.byte(start + 12));
    header.twoSamples = length == kTwoSamples;
    const bool isEtc1s = header.model == Model::Etc1s;
    if (!isEtc1s && header.model != Model::Uastc) {
        return fmt::format(
            "it holds {}, which Glint does not read; KHR_texture_basisu allows ETC1S and UASTC",
            nameOf(header.model));
    }
    const bool schemeFits = isEtc1s ? header.scheme == Scheme::BasisLz
                                    : header.scheme == Scheme::None || header.scheme == Scheme::Zstandard;
    if (!schemeFits) {
        return fmt::format(
            "its supercompression scheme is {}, which KHR_texture_basisu does not allow for {}",
            static_cast<std::uint32_t>(header.scheme), isEtc1s ? "ETC1S" : "UASTC");
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
        return "its channels are neither RGB nor RGBA, which is all that KHR_texture_basisu allows";
    }
    const std::uint8_t primaries = file.byte(start + 13);
    if (primaries != kPrimariesUnspecified && primaries != kPrimariesBt709) {
        image.deviations.push_back(fmt::format(
            "its colour primaries have the number {}; they are taken for those of BT.709", primaries));
    }
    const std::uint8_t transfer = file.byte(start + 14);
    if (transfer != kTransferLinear && transfer != kTransferSrgb) {
        return fmt::format("its transfer function has the number {}, which is neither linear nor sRGB",
                           transfer);
    }
    image.transfer = transfer == kTransferSrgb ? Transfer::Srgb : Transfer::Linear;
    if ((file.byte(start + 15) & kPremultiplied) != 0) {
        image.deviations.emplace_back("its alpha is premultiplied; it is read as if it were not");
    }
    return "";
}

// Checks the key and value data. They are pairs of text, each with its length before it, at multiples of 4
// bytes.
std::string checkMetadata(const Ktx2Reader& file, Ktx2& image) {
    std::uint64_t place = file.word(56);
    const std::uint64_t length = file.word(60);
    if (length == 0) {
        return "";
    }
    constexpr const char* kDamaged = "its metadata are damaged";
    if (place < kHeaderBytes || !file.has(place, length)) {
        return kDamaged;
    }
    const std::uint64_t end = place + length;
    while (end - place > 4) {
        const std::uint64_t bytes = file.word(place);
        place += 4;
        if (bytes < 2 || bytes > end - place) {
            return kDamaged;
        }
        const std::string_view pair = file.text(place, bytes);
        const std::size_t split = pair.find('\0');
        if (split == std::string_view::npos) {
            return kDamaged;
        }
        const std::string_view key = pair.substr(0, split);
        std::string_view value = pair.substr(split + 1);
        value = value.substr(0, value.find('\0'));
        if (key == "KTXanimData") {
            return "it is a video";
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
    return "";
}

// Returns how many blocks the level has.
std::uint64_t blocksOf(const Header& header, std::uint32_t level) {
    const std::uint64_t width = std::max(header.width >> level, 1U);
    const std::uint64_t height = std::max(header.height >> level, 1U);
    return (width + 3) / 4 * ((height + 3) / 4);
}

// Checks the code books of ETC1S data, and where the data of each level lie in it.
std::string checkGlobalData(const Ktx2Reader& file, const Header& header) {
    const std::uint64_t start = file.longWord(64);
    const std::uint64_t length = file.longWord(72);
    std::uint64_t needed = kEtc1sHeaderBytes + kEtc1sImageBytes * header.levels;
    if (start < kHeaderBytes || !file.has(start, length) || length < needed) {
        return "its global data are damaged";
    }
    for (std::uint64_t part = 0; part < 4; ++part) {
        needed += file.word(start + 4 + 4 * part);
    }
    if (length < needed) {
        return "its global data are damaged";
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
                return fmt::format("its level {} is damaged", level);
            }
        }
    }
    return "";
}

std::string checkLevels(const Ktx2Reader& file, const Header& header) {
    for (std::uint32_t level = 0; level < header.levels; ++level) {
        const std::uint64_t entry = kHeaderBytes + kLevelBytes * level;
        const std::uint64_t start = file.longWord(entry);
        const std::uint64_t length = file.longWord(entry + 8);
        const std::uint64_t unpacked = file.longWord(entry + 16);
        const std::uint64_t wanted =
            header.scheme == Scheme::BasisLz ? 0 : kBlockBytes * blocksOf(header, level);
        if (start < kHeaderBytes + kLevelBytes * header.levels || !file.has(start, length) || length == 0 ||
            unpacked != wanted || (header.scheme == Scheme::None && length != wanted)) {
            return fmt::format("its level {} is damaged", level);
        }
        // Section 3.9.7, "mipPadding", requires this. The transcoder reads blocks as structures.
        if (header.scheme == Scheme::None && start % kBlockBytes != 0) {
            return fmt::format("its level {} does not start at a multiple of {} bytes", level, kBlockBytes);
        }
    }
    return header.scheme == Scheme::BasisLz ? checkGlobalData(file, header) : "";
}

}  // namespace

std::optional<Ktx2> readKtx2(ByteView bytes, std::string& problem) {
    const Ktx2Reader file(bytes);
    // Every file has at least one level in its index.
    if (!file.has(0, kHeaderBytes + kLevelBytes) ||
        bytes.size() > std::numeric_limits<std::uint32_t>::max()) {
        problem =
            bytes.size() < kHeaderBytes + kLevelBytes ? "it ends within its header" : "larger than 4 GiB";
        return std::nullopt;
    }
    Header header;
    Ktx2 image;
    problem = checkShape(file, header);
    if (problem.empty()) {
        problem = checkFormat(file, header, image);
    }
    if (problem.empty()) {
        problem = checkMetadata(file, image);
    }
    if (problem.empty()) {
        problem = checkLevels(file, header);
    }
    if (!problem.empty()) {
        return std::nullopt;
    }
    image.width = static_cast<int>(header.width);
    image.height = static_cast<int>(header.height);
    image.levels = static_cast<int>(header.levels);
    if (image.width % 4 != 0 || image.height % 4 != 0) {
        image.deviations.emplace_back("its width and height are not multiples of 4; it is read all the same");
    }
    return image;
}

bool readKtx2Header(ByteView bytes, Image& image, std::string& problem) {
    const std::optional<Ktx2> file = readKtx2(bytes, problem);
    if (!file) {
        return false;
    }
    image.width = file->width;
    image.height = file->height;
    image.levels = file->levels;
    image.transfer = file->transfer;
    image.format = PixelFormat::Rgba8;
    return true;
}

}  // namespace glint::gltf

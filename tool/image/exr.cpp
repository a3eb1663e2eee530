#include "image/exr.h"

#include "base/image_limits.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <half.h>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::image {

namespace {

// The layout is described in "OpenEXR File Layout", https://openexr.com/en/latest/OpenEXRFileLayout.html
constexpr std::size_t kHeaderStart = 8;
constexpr std::uint32_t kMultipart = 0x1000;
// The library has room for a whole block of pixels before it reads one. The largest block of four 32-bit
// channels and 16384 columns has half of this, in 256 lines.
constexpr double kMaxBlockBytes = 1ULL << 27;

class ExrReader {
public:
    ExrReader(std::string_view bytes, std::size_t start)
        : rest_(bytes.substr(std::min(start, bytes.size()))) {}

    // Reads a zero-terminated text. Returns nothing if the file ends first.
    std::optional<std::string_view> text() {
        const std::size_t end = rest_.find('\0');
        if (end == std::string_view::npos) {
            return std::nullopt;
        }
        const std::string_view found = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        return found;
    }
    std::optional<std::uint32_t> word() {
        std::uint32_t value = 0;
        if (rest_.size() < sizeof value) {
            return std::nullopt;
        }
        std::memcpy(&value, rest_.data(), sizeof value);
        rest_.remove_prefix(sizeof value);
        return value;
    }
    bool skip(std::size_t size) {
        if (size > rest_.size()) {
            return false;
        }
        rest_.remove_prefix(size);
        return true;
    }

    std::string_view rest() const {
        return rest_;
    }
    bool atEnd() const {
        return rest_.empty();
    }

private:
    std::string_view rest_;
};

// For these attribute types the library ignores the size that the file gives. A wrong size would make it read
// everything that follows as something else.
struct FixedType {
    std::string_view name;
    std::size_t size;
};
constexpr std::array kFixedTypes{
    FixedType{"box2i", 16},      FixedType{"box2f", 16},   FixedType{"chromaticities", 32},
    FixedType{"compression", 1}, FixedType{"double", 8},   FixedType{"envmap", 1},
    FixedType{"float", 4},       FixedType{"int", 4},      FixedType{"keycode", 28},
    FixedType{"lineOrder", 1},   FixedType{"m33f", 36},    FixedType{"m44f", 64},
    FixedType{"m33d", 72},       FixedType{"m44d", 128},   FixedType{"rational", 8},
    FixedType{"tiledesc", 9},    FixedType{"timecode", 8}, FixedType{"v2i", 8},
    FixedType{"v2f", 8},         FixedType{"v2d", 16},     FixedType{"v3i", 12},
    FixedType{"v3f", 12},        FixedType{"v3d", 24},     FixedType{"deepImageState", 1}};

bool isStringVector(std::string_view value) {
    ExrReader reader(value, 0);
    while (!reader.atEnd()) {
        const std::optional<std::uint32_t> length = reader.word();
        if (!length || !reader.skip(*length)) {
            return false;
        }
    }
    return true;
}

bool isPreview(std::string_view value) {
    ExrReader reader(value, 0);
    const std::uint64_t width = reader.word().value_or(0);
    const std::uint64_t height = reader.word().value_or(0);
    constexpr std::size_t kSizeBytes = 8;
    return value.size() >= kSizeBytes && width * height == (value.size() - kSizeBytes) / 4;
}

std::int32_t wordAt(std::string_view value, std::size_t index) {
    std::int32_t word = 0;
    std::memcpy(&word, value.data() + index * sizeof word, sizeof word);
    return word;
}

// Returns the bytes of a pixel in all channels of a list, or nothing if `value` is no list of channels.
std::optional<double> bytesPerPixel(std::string_view value) {
    constexpr std::int32_t kHalf = 1;
    constexpr std::size_t kChannelBytes = 16;  // the first four are the type
    double bytes = 0.0;
    ExrReader reader(value, 0);
    std::optional<std::string_view> name = reader.text();
    for (; name && !name->empty(); name = reader.text()) {
        const std::string_view channel = reader.rest();
        if (!reader.skip(kChannelBytes)) {
            return std::nullopt;
        }
        bytes += wordAt(channel, 0) == kHalf ? 2.0 : 4.0;
    }
    return name && reader.atEnd() ? std::optional(bytes) : std::nullopt;
}

double linesOfBlock(std::string_view value) {
    // The index is the number of the compression, from none to DWAB.
    constexpr std::array kLines{1.0, 1.0, 1.0, 16.0, 32.0, 16.0, 32.0, 32.0, 32.0, 256.0};
    const auto compression = static_cast<unsigned char>(value[0]);
    return compression < kLines.size() ? kLines[compression] : kLines.back();
}

// Computes how many bytes one block of pixels takes from the attributes of a header. If an attribute occurs
// twice, the larger value counts.
class BlockSize {
public:
    // `value` has the size that its type asks for.
    void add(std::string_view name, std::string_view type, std::string_view value) {
        if (name == "dataWindow" && type == "box2i") {
            raise(width_, double{1} + wordAt(value, 2) - wordAt(value, 0));
        } else if (name == "channels" && type == "chlist") {
            raise(pixelBytes_, bytesPerPixel(value).value_or(0.0));
        } else if (name == "compression" && type == "compression") {
            raise(lines_, linesOfBlock(value));
        } else if (name == "tiles" && type == "tiledesc") {
            const auto side = [&](std::size_t index) {
                return static_cast<double>(static_cast<std::uint32_t>(wordAt(value, index)));
            };
            raise(tilePixels_, side(0) * side(1));
        }
    }
    double bytes() const {
        return pixelBytes_ * std::max(width_ * lines_, tilePixels_);
    }

private:
    static void raise(double& largest, double value) {
        largest = std::max(largest, value);
    }

    double width_ = 0.0;
    double lines_ = 0.0;
    double pixelBytes_ = 0.0;
    double tilePixels_ = 0.0;
};

// Returns whether the library reads the whole value and nothing beyond it.
bool fits(std::string_view type, std::string_view value) {
    const auto fixed = std::ranges::find(kFixedTypes, type, &FixedType::name);
    if (fixed != kFixedTypes.end()) {
        return value.size() == fixed->size;
    }
    // An ID manifest is compressed, and only deep pictures have one.
    return type == "chlist"         ? bytesPerPixel(value).has_value()
           : type == "stringvector" ? isStringVector(value)
           : type == "preview"      ? isPreview(value)
                                    : type != "idmanifest";
}

}  // namespace

std::string findExrExcess(std::span<const std::uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::optional<std::uint32_t> version = ExrReader(text, sizeof(std::uint32_t)).word();
    ExrReader reader(text, kHeaderStart);
    bool isEmpty = true;
    BlockSize block;
    while (version) {
        const std::optional<std::string_view> name = reader.text();
        if (!name) {
            return "its header ends early";
        }
        if (name->empty()) {
            // This is the end of a header. If there are several headers, an empty one is the last.
            if ((*version & kMultipart) == 0 || isEmpty) {
                break;
            }
            isEmpty = true;
            block = {};
            continue;
        }
        isEmpty = false;
        const std::optional<std::string_view> type = reader.text();
        const std::optional<std::uint32_t> size = type ? reader.word() : std::nullopt;
        const std::string_view rest = reader.rest();
        if (!size || !reader.skip(*size) || !fits(*type, rest.substr(0, *size))) {
            return "the size of its attribute " + std::string(*name) + " is wrong";
        }
        block.add(*name, *type, rest.substr(0, *size));
        if (block.bytes() > kMaxBlockBytes) {
            return "one block of its pixels would take more than 128 MiB";
        }
    }
    return {};
}

namespace {

constexpr std::array<const char*, 4> kChannelNames{"R", "G", "B", "A"};
constexpr std::size_t kExrPixelBytes = sizeof(std::array<float, 4>);
// As in checkImageSize(). While OpenEXR reads the header, it allocates for all lines, and for a block of
// them.
constexpr int kMaxHeaderSize = 16384;
// At its best, Deflate makes 516 pixels of 2 bytes out of one byte. Lossy compression makes more of a single
// colour, but no sensible file comes near this limit.
constexpr std::int64_t kMaxExrPixelsPerByte = 1LL << 14;

class MemoryOutput : public Imf::OStream {
public:
    explicit MemoryOutput(const std::string& name) : OStream(name.c_str()) {}

    void write(const char c[], int n) override {
        const auto count = static_cast<std::size_t>(n);
        bytes_.resize(std::max(bytes_.size(), position_ + count));
        std::memcpy(bytes_.data() + position_, c, count);
        position_ += count;
    }
    uint64_t tellp() override {
        return position_;
    }
    void seekp(uint64_t pos) override {
        position_ = pos;
    }
    base::Bytes take() {
        return std::move(bytes_);
    }

private:
    base::Bytes bytes_;
    std::size_t position_ = 0;
};

class MemoryInput : public Imf::IStream {
public:
    MemoryInput(std::span<const std::uint8_t> bytes, const std::string& name)
        : IStream(name.c_str()), bytes_(bytes) {}

    // Throws beyond the end, as OpenEXR's contract for streams demands. decodeExr() catches it.
    bool read(char c[], int n) override {
        const auto count = static_cast<std::size_t>(std::max(n, 0));
        if (position_ > bytes_.size() || count > bytes_.size() - position_) {
            throw std::runtime_error("the file ends early");
        }
        std::memcpy(c, bytes_.data() + position_, count);
        position_ += count;
        return position_ < bytes_.size();
    }
    uint64_t tellg() override {
        return position_;
    }
    void seekg(uint64_t pos) override {
        position_ = pos;
    }

    std::int64_t size() const {
        return static_cast<std::int64_t>(bytes_.size());
    }

private:
    std::span<const std::uint8_t> bytes_;
    std::size_t position_ = 0;
};

// Returns the four channels of `pixels`, whose first pixel is at (left, top).
Imf::FrameBuffer frameBuffer(std::array<float, 4>* pixels, std::size_t width, int left, int top) {
    Imf::FrameBuffer buffer;
    const std::int64_t toOrigin = (left + static_cast<std::int64_t>(top) * static_cast<std::int64_t>(width)) *
                                  static_cast<std::int64_t>(kExrPixelBytes);
    for (std::size_t i = 0; i < kChannelNames.size(); ++i) {
        char* base = reinterpret_cast<char*>(pixels) + i * sizeof(float) - toOrigin;
        const double fill = i == 3 ? 1.0 : 0.0;
        buffer.insert(kChannelNames[i],
                      Imf::Slice(Imf::FLOAT, base, kExrPixelBytes, kExrPixelBytes * width, 1, 1, fill));
    }
    return buffer;
}

Diagnostic exrError(const std::string& where, const std::string& message) {
    return makeError("image-format", where, message, "write it again from the program that made it");
}

Result<LinearImage> decode(MemoryInput& stream, const std::string& where) {
    Imf::InputFile file(stream, 0);
    const Imf::ChannelList& channels = file.header().channels();
    for (std::size_t i = 0; i < kChannelNames.size(); ++i) {
        const Imf::Channel* channel = channels.findChannel(kChannelNames[i]);
        if (!channel && i < 3) {
            return exrError(where, std::string("has no channel ") + kChannelNames[i]);
        }
        if (channel && (channel->xSampling != 1 || channel->ySampling != 1)) {
            return exrError(where, std::string("has a subsampled channel ") + kChannelNames[i]);
        }
    }
    const Imath::Box2i window = file.header().dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    GLINT_TRY_DO(base::checkImageSize(width, height, where));
    if (width * height / kMaxExrPixelsPerByte > stream.size()) {
        return exrError(where, "says it has " + std::to_string(width) + " x " + std::to_string(height) +
                                   " pixels, but has only " + std::to_string(stream.size()) + " bytes");
    }
    LinearImage image{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
    image.pixels.resize(static_cast<std::size_t>(width * height));
    file.setFrameBuffer(frameBuffer(image.pixels.data(), image.width, window.min.x, window.min.y));
    file.readPixels(window.min.y, window.max.y);
    return image;
}

// The channels of a layer in a file. Half floats are converted here, because OpenEXR converts no channel
// types.
struct ExrChannels {
    std::vector<Imath::half> halves;
    const ExrLayer* layer = nullptr;

    explicit ExrChannels(const ExrLayer& source) : layer(&source) {
        if (source.isHalf) {
            halves.assign(source.values.reals.begin(), source.values.reals.end());
        }
    }

    Imf::PixelType type() const {
        return !layer->values.integers.empty() ? Imf::UINT : layer->isHalf ? Imf::HALF : Imf::FLOAT;
    }
    std::string name(std::size_t channel) const {
        return layer->name + "." + layer->channels[channel];
    }
    Imf::Slice slice(std::size_t channel) const {
        const std::size_t bytes = type() == Imf::HALF ? sizeof(Imath::half) : sizeof(float);
        const void* const first =
            type() == Imf::UINT   ? static_cast<const void*>(layer->values.integers.data())
            : type() == Imf::HALF ? static_cast<const void*>(halves.data())
                                  : static_cast<const void*>(layer->values.reals.data());
        // OpenEXR's frame buffer is not const even for writing, although it is then only read.
        char* const base = const_cast<char*>(static_cast<const char*>(first)) + channel * bytes;
        const std::size_t stride = bytes * layer->values.components;
        return {type(), base, stride, stride * layer->values.width};
    }
};

}  // namespace

Result<base::Bytes> encodeExr(const LinearImage& image, const std::string& where,
                              std::span<const ExrLayer> layers) {
    try {
        Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
        header.compression() = Imf::ZIP_COMPRESSION;
        for (const char* name : kChannelNames) {
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        }
        const std::vector<ExrChannels> beside(layers.begin(), layers.end());
        for (const ExrChannels& channels : beside) {
            for (std::size_t i = 0; i < channels.layer->channels.size(); ++i) {
                header.channels().insert(channels.name(i), Imf::Channel(channels.type()));
            }
        }
        MemoryOutput stream(where);
        {
            // OpenEXR's frame buffer is not const even for writing, although it is then only read.
            std::vector<std::array<float, 4>> pixels = image.pixels;
            Imf::OutputFile file(stream, header, 0);
            Imf::FrameBuffer buffer = frameBuffer(pixels.data(), image.width, 0, 0);
            for (const ExrChannels& channels : beside) {
                for (std::size_t i = 0; i < channels.layer->channels.size(); ++i) {
                    buffer.insert(channels.name(i), channels.slice(i));
                }
            }
            file.setFrameBuffer(buffer);
            file.writePixels(static_cast<int>(image.height));
        }
        return stream.take();
    } catch (const std::exception& error) {
        return makeError("exr-encode", where, std::string("can't be encoded as OpenEXR: ") + error.what(),
                         "check the size of the image");
    }
}

Result<LinearImage> decodeExr(std::span<const std::uint8_t> bytes, const std::string& where) {
    if (const std::string excess = findExrExcess(bytes); !excess.empty()) {
        return exrError(where, "is no OpenEXR file that can be read: " + excess);
    }
    try {
        // This limit applies to the whole process; it is always set to the same value.
        Imf::Header::setMaxImageSize(kMaxHeaderSize, kMaxHeaderSize);
        MemoryInput stream(bytes, where);
        return decode(stream, where);
    } catch (const std::exception& error) {
        return exrError(where, std::string("is no OpenEXR file that can be read: ") + error.what());
    }
}

}  // namespace glint::image

#include "image/exr.h"

#include "base/image_limits.h"
#include "image/exr_bounds.h"

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
#include <stdexcept>
#include <utility>
#include <vector>

namespace glint::image {

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

#include "base/image_limits.h"
#include "image/image_file.h"

#include <algorithm>
#include <cstring>
#include <memory>

#ifndef __clang_analyzer__  // third-party code is not linted
#define STB_IMAGE_IMPLEMENTATION
#endif
#define STB_IMAGE_STATIC
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#include <stb_image.h>

namespace glint::image {

namespace {

// A run of 127 pixels takes 2 bytes in each of 4 channels.
constexpr std::int64_t kMaxHdrPixelsPerByte = 16;
// stb_image asks for at most 4 bytes of a flat pixel; otherwise it asks for its whole buffer.
constexpr int kHdrPixelBytes = 4;
// The byte that stb_image reads beyond the end of the file: a run of 127 pixels. With runs of no pixels it
// would read forever.
constexpr char kPastEnd = '\xFF';

// Gives stb_image the file, and notes if it asks for bytes that are not there.
class HdrReader {
public:
    HdrReader(std::span<const std::uint8_t> bytes, bool padded) : bytes_(bytes), padded_(padded) {}

    static const stbi_io_callbacks& callbacks() {
        static constexpr stbi_io_callbacks kCallbacks{
            [](void* user, char* data, int size) { return static_cast<HdrReader*>(user)->read(data, size); },
            [](void* user, int n) { static_cast<HdrReader*>(user)->skip(n); },
            [](void* user) { return static_cast<HdrReader*>(user)->atEnd() ? 1 : 0; }};
        return kCallbacks;
    }
    bool ranOut() const {
        return ranOut_;
    }

private:
    int read(char* data, int size) {
        const std::size_t count = std::min(static_cast<std::size_t>(size), bytes_.size() - position_);
        if (count == 0 || (size <= kHdrPixelBytes && count < static_cast<std::size_t>(size))) {
            ranOut_ = true;
        }
        std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(position_), count, data);
        position_ += count;
        if (count == 0 && padded_) {
            std::fill_n(data, size, kPastEnd);
            return size;
        }
        return static_cast<int>(count);
    }
    void skip(int n) {
        const auto target = static_cast<std::ptrdiff_t>(position_) + n;
        position_ = static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(target, 0, static_cast<std::ptrdiff_t>(bytes_.size())));
    }
    bool atEnd() const {
        return position_ == bytes_.size();
    }

    std::span<const std::uint8_t> bytes_;
    bool padded_;
    std::size_t position_ = 0;
    bool ranOut_ = false;
};

struct StbFree {
    void operator()(float* pixels) const {
        stbi_image_free(pixels);
    }
};

Diagnostic hdrError(const std::string& where, const std::string& message) {
    return makeError("image-format", where, message, "write it again from the program that made it");
}

}  // namespace

Result<LinearImage> decodeHdr(std::span<const std::uint8_t> bytes, const std::string& where) {
    int width = 0;
    int height = 0;
    int channels = 0;
    // The header must end within the file.
    HdrReader header(bytes, false);
    if (stbi_info_from_callbacks(&HdrReader::callbacks(), &header, &width, &height, &channels) == 0) {
        return hdrError(where, "is no Radiance picture (.hdr) that can be read");
    }
    GLINT_TRY_DO(base::checkImageSize(width, height, where));
    const std::int64_t count = std::int64_t{width} * height;
    if (count / kMaxHdrPixelsPerByte > static_cast<std::int64_t>(bytes.size())) {
        return hdrError(where, "says it has " + std::to_string(width) + " x " + std::to_string(height) +
                                   " pixels, but has only " + std::to_string(bytes.size()) + " bytes");
    }
    HdrReader reader(bytes, true);
    const std::unique_ptr<float, StbFree> pixels(stbi_loadf_from_callbacks(
        &HdrReader::callbacks(), &reader, &width, &height, &channels, STBI_rgb_alpha));
    if (!pixels) {
        return hdrError(where,
                        std::string("is no Radiance picture that can be read: ") + stbi_failure_reason());
    }
    if (reader.ranOut()) {
        return hdrError(where, "ends early, or has a broken scan line");
    }
    LinearImage image{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
    image.pixels.resize(static_cast<std::size_t>(count));
    std::memcpy(image.pixels.data(), pixels.get(), image.pixels.size() * sizeof(image.pixels[0]));
    return image;
}

}  // namespace glint::image

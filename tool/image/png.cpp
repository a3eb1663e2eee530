#include "image/png.h"

#include "base/image_limits.h"
#include "image/tone.h"

#include <array>
#include <limits>
#include <memory>
#include <vector>

// Functions of stb get internal linkage, because another part of the program may carry its own copy.
#define STB_IMAGE_STATIC
#ifndef __clang_analyzer__  // third-party code is not linted
#define STB_IMAGE_IMPLEMENTATION
#endif
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb_image.h>
#define STB_IMAGE_WRITE_STATIC
#ifndef __clang_analyzer__
#define STB_IMAGE_WRITE_IMPLEMENTATION
#endif
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

namespace glint::image {

namespace {

constexpr int kChannels = 4;
constexpr const char* kRewrite = "write it again from the program that made it";

struct StbDeleter {
    void operator()(void* memory) const {
        stbi_image_free(memory);
    }
};
template <typename T>
using StbPixels = std::unique_ptr<T, StbDeleter>;

void append(void* target, void* data, int size) {
    auto* bytes = static_cast<base::Bytes*>(target);
    const auto* begin = static_cast<const std::uint8_t*>(data);
    bytes->insert(bytes->end(), begin, begin + size);
}

// Linear values of all levels of T.
template <typename T>
std::vector<float> makeLinearLevels() {
    std::vector<float> linear(std::size_t{std::numeric_limits<T>::max()} + 1);
    for (std::size_t i = 0; i < linear.size(); ++i) {
        linear[i] = srgbToLinear(static_cast<float>(i) / static_cast<float>(linear.size() - 1));
    }
    return linear;
}

// Takes over samples of T with four channels; 256 or 65536 levels, so that a table does for the transfer
// function. Returns false if there are none.
template <typename T>
bool linearize(T* decoded, LinearImage& image) {
    const StbPixels<T> owner(decoded);
    const T* samples = decoded;
    static const std::vector<float> linear = makeLinearLevels<T>();
    constexpr auto kLargest = static_cast<float>(std::numeric_limits<T>::max());
    if (samples == nullptr) {
        return false;
    }
    for (std::array<float, 4>& pixel : image.pixels) {
        pixel = {linear[samples[0]], linear[samples[1]], linear[samples[2]],
                 static_cast<float>(samples[3]) / kLargest};
        samples += kChannels;
    }
    return true;
}

Diagnostic unreadable(const std::string& where) {
    const char* reason = stbi_failure_reason();
    return makeError("image-format", where,
                     std::string("is no PNG file that can be read: ") + (reason ? reason : "no reason given"),
                     kRewrite);
}

}  // namespace

Result<base::Bytes> encodePng(const DisplayImage& image, const std::string& where) {
    base::Bytes bytes;
    const auto width = static_cast<int>(image.width);
    const auto height = static_cast<int>(image.height);
    if (image.pixels.empty() ||
        stbi_write_png_to_func(append, &bytes, width, height, 3, image.pixels.data(), 3 * width) == 0) {
        return makeError("png-encode", where, "can't be encoded as PNG", "check the size of the image");
    }
    return bytes;
}

Result<LinearImage> decodePng(std::span<const std::uint8_t> bytes, const std::string& where) {
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        return makeError("image-size", where, "is longer than 2 GiB");
    }
    const auto size = static_cast<int>(bytes.size());
    int width = 0;
    int height = 0;
    int channels = 0;
    if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) {
        return unreadable(where);
    }
    GLINT_TRY_DO(base::checkImageSize(width, height, where));
    if (const std::string excess = base::findPngExcess(bytes, width, height); !excess.empty()) {
        return makeError("image-format", where, "is no PNG file that can be read: " + excess, kRewrite);
    }
    LinearImage image{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
    image.pixels.resize(std::size_t{image.width} * image.height);
    const bool isDecoded =
        stbi_is_16_bit_from_memory(bytes.data(), size) != 0
            ? linearize(stbi_load_16_from_memory(bytes.data(), size, &width, &height, &channels, kChannels),
                        image)
            : linearize(stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, kChannels),
                        image);
    if (!isDecoded) {
        return unreadable(where);
    }
    return image;
}

}  // namespace glint::image

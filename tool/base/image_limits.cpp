#include "base/image_limits.h"

#include <cstddef>
#include <string_view>

namespace glint::base {

Status checkImageSize(std::int64_t width, std::int64_t height, const std::string& where) {
    if (width >= 1 && height >= 1 && width <= kMaxImageSize && height <= kMaxImageSize &&
        width * height <= kMaxImagePixels) {
        return okStatus();
    }
    return makeError("image-size", where,
                     "is " + std::to_string(width) + " x " + std::to_string(height) +
                         " pixels; Glint takes 1 to 16384 each way and 67108864 in all");
}

namespace {

// Deflate reaches 1032 : 1 at best, and a pixel has at least one bit.
constexpr std::uint64_t kMaxPixelsPerByte = 1032ULL * 8;

}  // namespace

std::string findPngExcess(std::span<const std::uint8_t> bytes, std::int64_t width, std::int64_t height) {
    const std::uint64_t pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    if (pixels / kMaxPixelsPerByte > bytes.size()) {
        return "it says it has " + std::to_string(width) + " x " + std::to_string(height) +
               " pixels, but has only " + std::to_string(bytes.size()) + " bytes";
    }
    constexpr std::size_t kSignatureBytes = 8;
    constexpr std::size_t kHeaderBytes = 8;  // length and type; a checksum follows the data
    constexpr std::size_t kChecksumBytes = 4;
    bool hasData = false;
    for (std::size_t at = kSignatureBytes; at + kHeaderBytes <= bytes.size();) {
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            length = length << 8U | bytes[at + i];
        }
        const std::string_view type(reinterpret_cast<const char*>(bytes.data()) + at + 4, 4);
        if (type == "IEND") {
            break;
        }
        if (type == "IDAT") {
            // stb_image would copy an empty chunk to a null pointer. PNG allows it, but no encoder begins
            // with one.
            if (length == 0 && !hasData) {
                return "its first chunk of data is empty";
            }
            hasData = true;
        }
        at += kHeaderBytes;
        if (length + kChecksumBytes > bytes.size() - at) {
            return "a chunk of " + std::to_string(length) + " bytes goes beyond its end";
        }
        at += length + kChecksumBytes;
    }
    return {};
}

}  // namespace glint::base

// Decodes PNG and JPEG images.
#include "base/image_limits.h"
#include "gltf/codecs/codecs.h"

#include <fmt/format.h>

#include <cstddef>
#include <limits>
#include <memory>
#include <numeric>

#ifndef __clang_analyzer__  // the linter skips the library's code
#define STB_IMAGE_IMPLEMENTATION
#endif
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb/stb_image.h>

namespace glint::gltf {

namespace {

// Checks a JPEG file for two things that stb_image does not check. Up to version 2.27 it writes behind its
// own tables for a Huffman table of more than 256 codes. Every scan also costs it a pass over all blocks,
// however few bytes the scan has.

constexpr std::uint8_t kMarker = 0xFF;
constexpr std::uint8_t kTables = 0xC4;
constexpr std::uint8_t kScan = 0xDA;
constexpr std::uint8_t kEnd = 0xD9;
constexpr std::size_t kLengthBytes = 2;
// Encoders make about ten scans. Those that try for the smallest file make fewer than a hundred.
constexpr int kMaxScans = 256;

// `rest` begins with the length of a segment. Returns 0 if there is none.
std::size_t segmentLength(std::span<const std::uint8_t> rest) {
    return rest.size() < kLengthBytes ? 0 : std::size_t{rest[0]} << 8U | rest[1];
}

bool isSoundSegment(std::span<const std::uint8_t> rest) {
    constexpr std::size_t kCountBytes = 16;
    constexpr std::size_t kMaxCodes = 256;
    const std::size_t length = segmentLength(rest);
    if (length < kLengthBytes || length > rest.size()) {
        return false;
    }
    for (rest = rest.subspan(kLengthBytes, length - kLengthBytes); !rest.empty();) {
        if (rest.size() < 1 + kCountBytes) {
            return false;
        }
        const auto counts = rest.subspan(1, kCountBytes);
        const std::size_t codes = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
        rest = rest.subspan(1 + kCountBytes);
        if (codes > kMaxCodes || codes > rest.size()) {
            return false;
        }
        rest = rest.subspan(codes);
    }
    return true;
}

// Accepts at most 256 scans, and tables of at most 256 codes that lie in their segments, as far as a decoder
// can reach them. The layout is that of ITU-T T.81, B.2.4.2.
Status checkJpeg(std::span<const std::uint8_t> bytes) {
    constexpr std::size_t kStartBytes = 2;
    // After the first scan every marker counts, because only a decoder knows where a scan ends.
    int scans = 0;
    for (std::size_t at = kStartBytes; at + 1 < bytes.size();) {
        if (bytes[at] != kMarker || bytes[at + 1] == kMarker) {
            ++at;
            continue;
        }
        const std::uint8_t marker = bytes[at + 1];
        at += 2;
        if (marker == kEnd) {
            break;
        }
        if (marker == kTables && !isSoundSegment(bytes.subspan(at))) {
            return imageFault("a Huffman table is damaged");
        }
        scans += marker == kScan ? 1 : 0;
        if (scans > kMaxScans) {
            return imageFault(fmt::format("it has more than {} scans", kMaxScans));
        }
        at += scans > 0 ? 0 : segmentLength(bytes.subspan(at));
    }
    return okStatus();
}

// A block of 8 x 8 values takes at least one bit of its scan. Several pixels may share a block. With three
// components that have 4 x 1, 1 x 4 and 1 x 1 values for each 4 x 4 pixels, 9 blocks make 32 x 32 pixels
// (ITU-T T.81, A.1.1 and F.1.2.1).
constexpr std::uint64_t kMaxPixelsPerJpegByte = 8ULL * 32 * 32 / 9 + 1;

struct StbFree {
    void operator()(void* pixels) const {
        stbi_image_free(pixels);
    }
};

Status readStbHeader(ByteView bytes, Image& image) {
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        return imageFault("larger than 2 GiB");
    }
    const int size = static_cast<int>(bytes.size());
    int components = 0;
    if (stbi_info_from_memory(bytes.data(), size, &image.width, &image.height, &components) == 0) {
        return imageFault(stbi_failure_reason());
    }
    image.format =
        stbi_is_16_bit_from_memory(bytes.data(), size) != 0 ? PixelFormat::Rgba16 : PixelFormat::Rgba8;
    return okStatus();
}

Status readPngHeader(ByteView bytes, Image& image) {
    GLINT_TRY_DO(readStbHeader(bytes, image));
    std::string excess = base::findPngExcess(bytes, image.width, image.height);
    return excess.empty() ? okStatus() : imageFault(std::move(excess));
}

Status readJpegHeader(ByteView bytes, Image& image) {
    // The header comes after tables, so these are checked first.
    GLINT_TRY_DO(checkJpeg(bytes));
    GLINT_TRY_DO(readStbHeader(bytes, image));
    const auto pixels = static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
    if (pixels / kMaxPixelsPerJpegByte > bytes.size()) {
        return imageFault(fmt::format("it says it has {} x {} pixels, but has only {} bytes", image.width,
                                      image.height, bytes.size()));
    }
    return okStatus();
}

Status decodeStb(ByteView bytes, Image& image) {
    const int size = static_cast<int>(bytes.size());
    const bool isDeep = image.format == PixelFormat::Rgba16;
    int width = 0;
    int height = 0;
    int components = 0;
    const std::unique_ptr<void, StbFree> pixels(
        isDeep ? static_cast<void*>(stbi_load_16_from_memory(bytes.data(), size, &width, &height, &components,
                                                             STBI_rgb_alpha))
               : stbi_load_from_memory(bytes.data(), size, &width, &height, &components, STBI_rgb_alpha));
    if (!pixels || width != image.width || height != image.height) {
        return imageFault(pixels ? "its size changes on the way" : stbi_failure_reason());
    }
    const auto* first = static_cast<const std::uint8_t*>(pixels.get());
    image.pixels.assign(first, first + bytesPerPixel(image.format) * static_cast<std::size_t>(width) *
                                           static_cast<std::size_t>(height));
    return okStatus();
}

}  // namespace

const Codec kPng{"PNG", "image/png", readPngHeader, decodeStb};
const Codec kJpeg{"JPEG", "image/jpeg", readJpegHeader, decodeStb};

}  // namespace glint::gltf

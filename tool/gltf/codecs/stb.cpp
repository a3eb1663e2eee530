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

// Returns why the file must not be decoded. The text is empty if there are at most 256 scans, and if every
// table that a decoder can reach has at most 256 codes and lies in its segment. The layout is that of ITU-T
// T.81, B.2.4.2.
std::string findJpegExcess(std::span<const std::uint8_t> bytes) {
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
            return "a Huffman table is damaged";
        }
        scans += marker == kScan ? 1 : 0;
        if (scans > kMaxScans) {
            return "it has more than " + std::to_string(kMaxScans) + " scans";
        }
        at += scans > 0 ? 0 : segmentLength(bytes.subspan(at));
    }
    return {};
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

bool readStbHeader(ByteView bytes, Image& image, std::string& problem) {
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        problem = "larger than 2 GiB";
        return false;
    }
    const int size = static_cast<int>(bytes.size());
    int components = 0;
    if (stbi_info_from_memory(bytes.data(), size, &image.width, &image.height, &components) == 0) {
        problem = stbi_failure_reason();
        return false;
    }
    image.format =
        stbi_is_16_bit_from_memory(bytes.data(), size) != 0 ? PixelFormat::Rgba16 : PixelFormat::Rgba8;
    return true;
}

bool readPngHeader(ByteView bytes, Image& image, std::string& problem) {
    if (!readStbHeader(bytes, image, problem)) {
        return false;
    }
    problem = base::findPngExcess(bytes, image.width, image.height);
    return problem.empty();
}

bool readJpegHeader(ByteView bytes, Image& image, std::string& problem) {
    // The header comes after tables, so these are checked first.
    problem = findJpegExcess(bytes);
    if (!problem.empty()) {
        return false;
    }
    if (!readStbHeader(bytes, image, problem)) {
        return false;
    }
    const auto pixels = static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
    if (pixels / kMaxPixelsPerJpegByte > bytes.size()) {
        problem = fmt::format("it says it has {} x {} pixels, but has only {} bytes", image.width,
                              image.height, bytes.size());
        return false;
    }
    return true;
}

bool decodeStb(ByteView bytes, Image& image, std::string& problem) {
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
        problem = pixels ? "its size changes on the way" : stbi_failure_reason();
        return false;
    }
    const auto* first = static_cast<const std::uint8_t*>(pixels.get());
    image.pixels.assign(first, first + bytesPerPixel(image.format) * static_cast<std::size_t>(width) *
                                           static_cast<std::size_t>(height));
    return true;
}

}  // namespace

const Codec kPng{"PNG", "image/png", readPngHeader, decodeStb};
const Codec kJpeg{"JPEG", "image/jpeg", readJpegHeader, decodeStb};

}  // namespace glint::gltf

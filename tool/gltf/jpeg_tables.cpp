#include "gltf/jpeg_tables.h"

#include <cstddef>
#include <numeric>

namespace glint::gltf {

namespace {

constexpr std::uint8_t kMarker = 0xFF;
constexpr std::uint8_t kTables = 0xC4;
constexpr std::uint8_t kScan = 0xDA;
constexpr std::uint8_t kEnd = 0xD9;
constexpr std::size_t kLengthBytes = 2;

// `rest` begins with the length of a segment; 0 where there is none.
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

}  // namespace

bool hasSoundTables(std::span<const std::uint8_t> bytes) {
    constexpr std::size_t kStartBytes = 2;
    // Behind the first scan any marker counts: where one scan ends is known to who decodes it only.
    bool isBehindScan = false;
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
            return false;
        }
        isBehindScan = isBehindScan || marker == kScan;
        at += isBehindScan ? 0 : segmentLength(bytes.subspan(at));
    }
    return true;
}

}  // namespace glint::gltf

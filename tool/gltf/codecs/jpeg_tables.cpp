#include "gltf/codecs/jpeg_tables.h"

#include <cstddef>
#include <numeric>

namespace glint::gltf {

namespace {

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

}  // namespace

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

}  // namespace glint::gltf

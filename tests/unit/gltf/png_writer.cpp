#include "unit/gltf/png_writer.h"

#include <algorithm>
#include <cstddef>

namespace glint::test {

namespace {

void appendBigEndian(base::Bytes& bytes, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) {
        bytes.push_back(static_cast<std::uint8_t>(value >> static_cast<unsigned>(shift)));
    }
}

// The algorithm is in ISO 3309 and in PNG's annex D.
std::uint32_t crc32(const base::Bytes& bytes) {
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc & 1U) != 0 ? crc >> 1U ^ 0xEDB88320U : crc >> 1U;
        }
    }
    return ~crc;
}

void appendChunk(base::Bytes& png, const std::string& type, const base::Bytes& content) {
    appendBigEndian(png, static_cast<std::uint32_t>(content.size()));
    base::Bytes body(type.begin(), type.end());
    body.insert(body.end(), content.begin(), content.end());
    png.insert(png.end(), body.begin(), body.end());
    appendBigEndian(png, crc32(body));
}

// The format is that of RFC 1950 and 1951, with stored blocks.
base::Bytes storeZlib(const base::Bytes& data) {
    constexpr std::size_t kLargestBlock = 65535;
    base::Bytes stream{0x78, 0x01};
    std::uint32_t a = 1;
    std::uint32_t b = 0;
    for (const std::uint8_t byte : data) {
        a = (a + byte) % 65521;
        b = (b + a) % 65521;
    }
    for (std::size_t first = 0; first < data.size(); first += kLargestBlock) {
        const std::size_t size = std::min(kLargestBlock, data.size() - first);
        stream.push_back(first + size == data.size() ? 1 : 0);
        for (const std::size_t length : {size, ~size}) {
            stream.push_back(static_cast<std::uint8_t>(length));
            stream.push_back(static_cast<std::uint8_t>(length >> 8U));
        }
        const auto start = data.begin() + static_cast<std::ptrdiff_t>(first);
        stream.insert(stream.end(), start, start + static_cast<std::ptrdiff_t>(size));
    }
    appendBigEndian(stream, b << 16U | a);
    return stream;
}

}  // namespace

base::Bytes makePng(const PngSpec& spec) {
    base::Bytes png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    base::Bytes header;
    appendBigEndian(header, spec.width);
    appendBigEndian(header, spec.height);
    header.insert(header.end(), {spec.bitDepth, static_cast<std::uint8_t>(spec.color), 0, 0, 0});
    appendChunk(png, "IHDR", header);
    for (const auto& [type, content] : spec.chunks) {
        appendChunk(png, type, content);
    }
    base::Bytes filtered;
    const std::size_t rowBytes = spec.rows.size() / spec.height;
    for (std::size_t row = 0; row < spec.height; ++row) {
        filtered.push_back(0);
        const auto start = spec.rows.begin() + static_cast<std::ptrdiff_t>(row * rowBytes);
        filtered.insert(filtered.end(), start, start + static_cast<std::ptrdiff_t>(rowBytes));
    }
    appendChunk(png, "IDAT", storeZlib(filtered));
    appendChunk(png, "IEND", {});
    return png;
}

}  // namespace glint::test

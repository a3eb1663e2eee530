// Images in block formats, as KTX2 and DDS files hold them.
#pragma once

#include "gltf/document/files.h"
#include "gltf/scene.h"

#include <glint/result.h>
#include <glint/scene_view.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::gltf {

// Reads little-endian numbers at places that were found to lie in the file.
class FileReader {
public:
    explicit FileReader(ByteView bytes) : bytes_(bytes) {}

    bool has(std::uint64_t offset, std::uint64_t length) const {
        return offset <= bytes_.size() && length <= bytes_.size() - offset;
    }
    std::uint8_t byte(std::uint64_t offset) const {
        return bytes_[static_cast<std::size_t>(offset)];
    }
    std::uint32_t word(std::uint64_t offset) const {
        return static_cast<std::uint32_t>(byte(offset) | byte(offset + 1) << 8U | byte(offset + 2) << 16U) |
               static_cast<std::uint32_t>(byte(offset + 3)) << 24U;
    }
    std::uint64_t longWord(std::uint64_t offset) const {
        return word(offset) | static_cast<std::uint64_t>(word(offset + 4)) << 32U;
    }
    std::string_view text(std::uint64_t offset, std::uint64_t length) const {
        return {reinterpret_cast<const char*>(bytes_.data()) + offset, static_cast<std::size_t>(length)};
    }

private:
    ByteView bytes_;
};

// The checked header of a file: every level lies in the file and is as long as its blocks are.
struct BlockFile {
    int width = 0;  // all sizes are in pixels
    int height = 0;
    int levels = 0;  // from 1 up to the levels of a full pyramid
    Transfer transfer = Transfer::Unknown;
    std::optional<TexelFormat> format;  // none: data of Basis Universal, in KTX2 alone
    bool isEtc1s = false;               // of these: ETC1S, not UASTC
    bool hasAlpha = true;               // false: alpha is 1 whatever the blocks say
    bool isZstandard = false;           // each level is compressed by Zstandard
    struct Level {
        std::uint64_t offset = 0;  // bytes
        std::uint64_t bytes = 0;
    };
    std::vector<Level> places;  // of each level, from the largest
    // Where the file breaks rules, and what Glint does then; each is one clause.
    std::vector<std::string> deviations;
};

// Returns the fault of a file. Its place and a hint are added where the image is known.
inline Diagnostic imageFault(std::string message) {
    return makeError("image-decode", "", std::move(message));
}

// Checks the size and the number of levels of an image.
Status checkImageShape(std::uint64_t width, std::uint64_t height, std::uint64_t levels);

// Accepts one two-dimensional image in BC1 to BC5 or BC7 with unsigned values: by the header's FourCC (DXT1
// to DXT5, ATI1, ATI2, BC4U, BC5U) or by a DX10 header. Source: Microsoft, "Programming Guide for DDS".
Result<BlockFile> readDds(ByteView bytes);

// Accepts one two-dimensional image: in ETC1S (with BasisLZ) or UASTC, as KHR_texture_basisu wants it, or in
// BC1 to BC5, BC7, ETC2, EAC or ASTC, which is a deviation. Data other than ETC1S may be compressed by
// Zstandard. It allocates nothing that depends on the file. Sources: KTX File Format Specification 2.0,
// sections 3 and 4; Khronos Data Format 1.3, section 5.
Result<BlockFile> readKtx2(ByteView bytes);

}  // namespace glint::gltf

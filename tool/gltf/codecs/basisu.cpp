// Basis Universal: its transcoder, and the packers and unpackers of blocks that it has for itself.
#include "gltf/codecs/basisu.h"

#include "gltf/codecs/ktx2.h"

#include <algorithm>
#include <basisu_transcoder.h>
#include <cstddef>
#include <cstring>
#include <zstd.h>

// The packers are declared in the headers of the transcoder, but the ASTC unpackers in one of their own.
#include <basisu_astc_helpers.h>

namespace glint::gltf {

namespace {

// Makes tables that all transcoders share.
void makeTables() {
    static const bool made = [] {
        basist::basisu_transcoder_init();
        return true;
    }();
    static_cast<void>(made);
}

// The transcoder sees a file only after readKtx2() has checked its lengths, because it adds some of them
// without checking for overflow.
class Transcoder {
public:
    bool open(ByteView bytes, std::string& problem) {
        makeTables();
        // Blocks lie at multiples of 16 bytes in the file, but a buffer view may start anywhere.
        constexpr std::uintptr_t kAlignment = 16;
        if (reinterpret_cast<std::uintptr_t>(bytes.data()) % kAlignment != 0) {
            aligned_.assign(bytes.begin(), bytes.end());
            bytes = aligned_;
        }
        if (!transcoder_.init(bytes.data(), static_cast<std::uint32_t>(bytes.size())) ||
            !transcoder_.start_transcoding()) {
            problem = "the transcoder of Basis Universal does not take its header or its code books";
            return false;
        }
        return true;
    }

    // `units` are blocks or pixels.
    bool level(std::uint32_t level, std::uint8_t* target, std::uint32_t units,
               basist::transcoder_texture_format format, std::uint32_t flags, std::string& problem) {
        if (!transcoder_.transcode_image_level(level, 0, 0, target, units, format, flags)) {
            problem = "the data of level " + std::to_string(level) + " are damaged";
            return false;
        }
        return true;
    }

private:
    base::Bytes aligned_;
    basist::ktx2_transcoder transcoder_;
};

std::optional<basist::transcoder_texture_format> transcoderFormat(TexelFormat format) {
    using Format = basist::transcoder_texture_format;
    switch (format) {
        case TexelFormat::Bc1:
            return Format::cTFBC1_RGB;
        case TexelFormat::Bc3:
            return Format::cTFBC3_RGBA;
        case TexelFormat::Bc7:
            return Format::cTFBC7_RGBA;
        case TexelFormat::Astc4x4:
            return Format::cTFASTC_LDR_4x4_RGBA;
        default:
            return std::nullopt;
    }
}

}  // namespace

bool hasBasisu() {
    return true;
}

bool decodeBasis(ByteView bytes, Image& image, std::string& problem) {
    Transcoder transcoder;
    if (!transcoder.open(bytes, problem)) {
        return false;
    }
    image.pixels.resize(byteCount(image));
    std::uint8_t* target = image.pixels.data();
    for (int level = 0; level < image.levels; ++level) {
        const auto pixels = static_cast<std::uint32_t>(pixelCount(image, level));
        if (!transcoder.level(static_cast<std::uint32_t>(level), target, pixels,
                              basist::transcoder_texture_format::cTFRGBA32, 0, problem)) {
            image.pixels.clear();
            return false;
        }
        target += std::size_t{4} * pixels;
    }
    return true;
}

std::optional<std::vector<std::uint8_t>> transcodeBasis(const BlockFile& file, ByteView bytes,
                                                        TexelFormat format, std::string& problem) {
    const auto target = transcoderFormat(format);
    if (!target) {
        problem = std::string("it can't be transcoded to ") + infoOf(format).name;
        return std::nullopt;
    }
    Transcoder transcoder;
    if (!transcoder.open(bytes, problem)) {
        return std::nullopt;
    }
    const auto width = static_cast<std::uint32_t>(file.width);
    const auto height = static_cast<std::uint32_t>(file.height);
    const auto levels = static_cast<std::uint32_t>(file.levels);
    std::vector<std::uint8_t> blocks(static_cast<std::size_t>(bytesOfLevels(format, width, height, levels)));
    std::uint8_t* place = blocks.data();
    for (std::uint32_t level = 0; level < levels; ++level) {
        const std::uint64_t size = bytesOfLevel(format, width, height, level);
        const auto units = static_cast<std::uint32_t>(size / infoOf(format).blockBytes);
        if (!transcoder.level(level, place, units, *target, basist::cDecodeFlagsHighQuality, problem)) {
            return std::nullopt;
        }
        place += size;
    }
    return blocks;
}

bool unpackBc7(const std::uint8_t* block, BlockTexels& texels) {
    makeTables();
    std::array<basist::color_rgba, 16> unpacked;
    if (!basist::bc7u::unpack_bc7(block, unpacked.data())) {
        // A reserved mode: the format gives it zeros.
        texels = {};
        return true;
    }
    for (std::size_t i = 0; i < texels.size(); ++i) {
        texels[i] = {unpacked[i].r, unpacked[i].g, unpacked[i].b, unpacked[i].a};
    }
    return true;
}

bool unpackAstc(const std::uint8_t* block, std::uint32_t width, std::uint32_t height, bool srgb,
                std::uint8_t* texels) {
    makeTables();
    astc_helpers::log_astc_block logical;
    const auto mode = srgb ? astc_helpers::cDecodeModeSRGB8 : astc_helpers::cDecodeModeLDR8;
    if (!astc_helpers::unpack_block(block, logical, width, height) ||
        !astc_helpers::decode_block(logical, texels, width, height, mode)) {
        constexpr std::array<std::uint8_t, 4> kError{255, 0, 255, 255};
        for (std::uint32_t i = 0; i < width * height; ++i) {
            std::copy(kError.begin(), kError.end(), texels + std::size_t{4} * i);
        }
    }
    return true;
}

bool packBlock(TexelFormat format, const BlockTexels& texels, const std::array<int, 2>& channels,
               std::uint8_t* block) {
    makeTables();
    const std::uint8_t* const bytes = texels.front().data();
    constexpr std::uint32_t kStride = 4;
    switch (format) {
        case TexelFormat::Bc1:
            basist::encode_bc1(block, bytes, basist::cEncodeBC1HighQuality);
            return true;
        case TexelFormat::Bc3:
            basist::encode_bc4(block, bytes + 3, kStride);
            basist::encode_bc1(block + 8, bytes, basist::cEncodeBC1HighQuality);
            return true;
        case TexelFormat::Bc4:
            basist::encode_bc4(block, bytes + channels[0], kStride);
            return true;
        case TexelFormat::Bc5:
            basist::encode_bc4(block, bytes + channels[0], kStride);
            basist::encode_bc4(block + 8, bytes + channels[1], kStride);
            return true;
        case TexelFormat::Bc7: {
            std::array<basist::color_rgba, 16> colors;
            for (std::size_t i = 0; i < texels.size(); ++i) {
                colors[i].set(texels[i][0], texels[i][1], texels[i][2], texels[i][3]);
            }
            // Without the optimisation of p-bits of mode 6, whose opaque blocks may get an alpha of 254.
            constexpr std::uint32_t kFlags = basist::bc7f::cPackBC7FlagDefaultPartiallyAnalytical &
                                             ~std::uint32_t{basist::bc7f::cPackBC7FlagPBitOptMode6};
            basist::bc7f::fast_pack_bc7_auto_rgba(block, colors.data(), kFlags);
            return true;
        }
        default:
            return false;
    }
}

bool unpackZstandard(ByteView from, std::span<std::uint8_t> to) {
    return ZSTD_decompress(to.data(), to.size(), from.data(), from.size()) == to.size();
}

}  // namespace glint::gltf

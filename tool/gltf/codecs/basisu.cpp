// Basis Universal: its transcoder, and the packers and unpackers of blocks that it has for itself.
#include "gltf/codecs/codecs.h"

#include <fmt/format.h>

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
    Status open(ByteView bytes) {
        makeTables();
        // Blocks lie at multiples of 16 bytes in the file, but a buffer view may start anywhere.
        constexpr std::uintptr_t kAlignment = 16;
        if (reinterpret_cast<std::uintptr_t>(bytes.data()) % kAlignment != 0) {
            aligned_.assign(bytes.begin(), bytes.end());
            bytes = aligned_;
        }
        if (!transcoder_.init(bytes.data(), static_cast<std::uint32_t>(bytes.size())) ||
            !transcoder_.start_transcoding()) {
            return imageFault("the transcoder of Basis Universal does not take its header or its code books");
        }
        return okStatus();
    }

    // Transcodes all layers of a level. `bytes` is its size in the format, whose units, blocks or pixels,
    // have `unit` bytes.
    Status level(const ImageShape& shape, int level, std::span<std::uint8_t> target, std::size_t unit,
                 basist::transcoder_texture_format format, std::uint32_t flags) {
        const auto layers = static_cast<std::uint32_t>(shape.layers);
        const bool isCube = shape.dimension == package::TextureEntry::Dimension::Cube;
        const std::size_t bytes = target.size() / layers;
        for (std::uint32_t i = 0; i < layers; ++i) {
            if (!transcoder_.transcode_image_level(static_cast<std::uint32_t>(level), isCube ? 0 : i,
                                                   isCube ? i : 0, target.data() + i * bytes,
                                                   static_cast<std::uint32_t>(bytes / unit), format, flags)) {
                return imageFault(fmt::format("the data of level {} are damaged", level));
            }
        }
        return okStatus();
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

Status decodeBasis(ByteView bytes, Image& image) {
    Transcoder transcoder;
    GLINT_TRY_DO(transcoder.open(bytes));
    base::Bytes texels(byteCount(image));
    std::span<std::uint8_t> rest(texels);
    for (int level = 0; level < image.levels; ++level) {
        const auto bytesHere = static_cast<std::size_t>(4 * pixelCount(image, level));
        GLINT_TRY_DO(transcoder.level(image, level, rest.first(bytesHere), 4,
                                      basist::transcoder_texture_format::cTFRGBA32, 0));
        rest = rest.subspan(bytesHere);
    }
    image.pixels = std::move(texels);
    return okStatus();
}

Result<base::Bytes> transcodeBasis(const BlockFile& file, ByteView bytes, TexelFormat format) {
    const auto target = transcoderFormat(format);
    if (!target) {
        return imageFault(fmt::format("it can't be transcoded to {}", infoOf(format).name));
    }
    Transcoder transcoder;
    GLINT_TRY_DO(transcoder.open(bytes));
    base::Bytes blocks;
    for (int level = 0; level < file.levels; ++level) {
        const std::size_t before = blocks.size();
        blocks.resize(before + static_cast<std::size_t>(levelBytes(file, format, level)));
        GLINT_TRY_DO(transcoder.level(file, level, std::span(blocks).subspan(before),
                                      infoOf(format).blockBytes, *target, basist::cDecodeFlagsHighQuality));
    }
    return blocks;
}

void unpackBc7(const std::uint8_t* block, BlockTexels& texels) {
    makeTables();
    std::array<basist::color_rgba, 16> unpacked;
    if (!basist::bc7u::unpack_bc7(block, unpacked.data())) {
        // A reserved mode: the format gives it zeros.
        texels = {};
        return;
    }
    for (std::size_t i = 0; i < texels.size(); ++i) {
        texels[i] = {unpacked[i].r, unpacked[i].g, unpacked[i].b, unpacked[i].a};
    }
}

void unpackAstc(const std::uint8_t* block, std::uint32_t width, std::uint32_t height, bool srgb,
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
}

void packBlock(TexelFormat format, const BlockTexels& texels, const std::array<int, 2>& channels,
               std::uint8_t* block) {
    makeTables();
    const std::uint8_t* const bytes = texels.front().data();
    constexpr std::uint32_t kStride = 4;
    switch (format) {
        case TexelFormat::Bc1:
            basist::encode_bc1(block, bytes, basist::cEncodeBC1HighQuality);
            break;
        case TexelFormat::Bc3:
            basist::encode_bc4(block, bytes + 3, kStride);
            basist::encode_bc1(block + 8, bytes, basist::cEncodeBC1HighQuality);
            break;
        case TexelFormat::Bc4:
            basist::encode_bc4(block, bytes + channels[0], kStride);
            break;
        case TexelFormat::Bc5:
            basist::encode_bc4(block, bytes + channels[0], kStride);
            basist::encode_bc4(block + 8, bytes + channels[1], kStride);
            break;
        case TexelFormat::Bc7: {
            std::array<basist::color_rgba, 16> colors;
            for (std::size_t i = 0; i < texels.size(); ++i) {
                colors[i].set(texels[i][0], texels[i][1], texels[i][2], texels[i][3]);
            }
            // Without the optimisation of p-bits of mode 6, whose opaque blocks may get an alpha of 254.
            constexpr std::uint32_t kFlags = basist::bc7f::cPackBC7FlagDefaultPartiallyAnalytical &
                                             ~std::uint32_t{basist::bc7f::cPackBC7FlagPBitOptMode6};
            basist::bc7f::fast_pack_bc7_auto_rgba(block, colors.data(), kFlags);
            break;
        }
        default:
            break;
    }
}

bool unpackZstandard(ByteView from, std::span<std::uint8_t> to) {
    return ZSTD_decompress(to.data(), to.size(), from.data(), from.size()) == to.size();
}

}  // namespace glint::gltf

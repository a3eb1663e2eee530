#include "gltf/codecs/codecs.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <webp/decode.h>

namespace glint::gltf {

// ---- WebP ----

namespace {

const char* describe(VP8StatusCode code) {
    switch (code) {
        case VP8_STATUS_OUT_OF_MEMORY:
            return "out of memory";
        case VP8_STATUS_UNSUPPORTED_FEATURE:
            return "a feature that libwebp does not decode";
        case VP8_STATUS_NOT_ENOUGH_DATA:
            return "not enough data";
        default:
            return "bitstream error";
    }
}

Status readWebpHeader(ByteView bytes, Image& image) {
    WebPBitstreamFeatures features;
    if (const VP8StatusCode code = WebPGetFeatures(bytes.data(), bytes.size(), &features);
        code != VP8_STATUS_OK) {
        return imageFault(describe(code));
    }
    if (features.has_animation != 0) {
        return imageFault("an animation, which EXT_texture_webp forbids");
    }
    image.width = features.width;
    image.height = features.height;
    image.format = PixelFormat::Rgba8;
    return okStatus();
}

Status decodeWebp(ByteView bytes, Image& image) {
    const int stride = 4 * image.width;
    image.pixels.resize(static_cast<std::size_t>(stride) * static_cast<std::size_t>(image.height));
    if (WebPDecodeRGBAInto(bytes.data(), bytes.size(), image.pixels.data(), image.pixels.size(), stride) ==
        nullptr) {
        image.pixels.clear();
        return imageFault("the data is damaged or ends early");
    }
    return okStatus();
}

// ---- KTX2 and DDS ----

Status readBlockHeader(ByteView bytes, Image& image) {
    GLINT_TRY(const auto file, readBlockFile(bytes));
    static_cast<ImageShape&>(image) = file;
    image.transfer = file.transfer;
    image.storage = !file.format                  ? Storage::Transcoded
                    : isBlockFormat(*file.format) ? Storage::Blocks
                                                  : Storage::Texels;
    image.format = file.format == TexelFormat::Rgba16 ? PixelFormat::Rgba16 : PixelFormat::Rgba8;
    return okStatus();
}

// Gives texels the channels that the file lacks, as a shader reads them: 0, and 1 for alpha.
base::Bytes withAllChannels(base::Bytes stored, const BlockFile& file) {
    if (file.channels == 4) {
        return stored;
    }
    const std::size_t all = infoOf(*file.format).blockBytes;
    const std::size_t given = all / 4 * static_cast<std::size_t>(file.channels);
    base::Bytes texels(stored.size() / given * all);
    for (std::size_t i = 0; i < stored.size() / given; ++i) {
        const auto texel = texels.begin() + static_cast<std::ptrdiff_t>(i * all);
        std::copy_n(stored.begin() + static_cast<std::ptrdiff_t>(i * given), given, texel);
        std::fill_n(texel + static_cast<std::ptrdiff_t>(all / 4 * 3), all / 4, std::uint8_t{255});
    }
    return texels;
}

Status decodeBlockFile(ByteView bytes, Image& image) {
    GLINT_TRY(const auto file, readBlockFile(bytes));
    if (!file.format) {
        return decodeBasis(bytes, image);
    }
    GLINT_TRY(auto blocks, blocksOf(file, bytes));
    if (!isBlockFormat(*file.format)) {
        image.pixels = withAllChannels(std::move(blocks), file);
        return okStatus();
    }
    base::Bytes pixels;
    ByteView rest(blocks);
    for (int i = 0; i < file.levels; ++i) {
        const auto level = static_cast<std::uint32_t>(i);
        const std::uint32_t width = sizeAtLevel(static_cast<std::uint32_t>(file.width), level);
        const std::uint32_t height = sizeAtLevel(static_cast<std::uint32_t>(file.height), level);
        const auto bytesHere = static_cast<std::size_t>(bytesOfLevel(*file.format, width, height, 0));
        for (int layer = 0; layer < layersOfLevel(file, i); ++layer) {
            GLINT_TRY(auto here, decodeBlocks(*file.format, file.transfer == Transfer::Srgb, width, height,
                                              rest.first(bytesHere)));
            for (std::size_t k = 3; !file.hasAlpha && k < here.size(); k += 4) {
                here[k] = 255;
            }
            pixels.insert(pixels.end(), here.begin(), here.end());
            rest = rest.subspan(bytesHere);
        }
    }
    image.pixels = std::move(pixels);
    return okStatus();
}

// ---- All codecs ----

std::string_view textOf(ByteView bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool isWebp(std::string_view text) {
    return text.size() >= 12 && text.starts_with("RIFF") && text.substr(8).starts_with("WEBP");
}

}  // namespace

const Codec kWebp{"WebP", "image/webp", readWebpHeader, decodeWebp};
const Codec kBasisu{"KTX2", "image/ktx2", readBlockHeader, decodeBlockFile};
const Codec kDds{"DDS", "image/vnd-ms.dds", readBlockHeader, decodeBlockFile};

const Codec* findCodec(ByteView bytes) {
    const std::string_view text = textOf(bytes);
    if (text.starts_with("\x89PNG")) {
        return &kPng;
    }
    if (text.starts_with("\xFF\xD8")) {
        return &kJpeg;
    }
    if (isWebp(text)) {
        return &kWebp;
    }
    if (text.starts_with("DDS ")) {
        return &kDds;
    }
    return text.starts_with("\xABKTX 20\xBB") ? &kBasisu : nullptr;
}

const char* foreignFormat(ByteView bytes) {
    const std::string_view text = textOf(bytes);
    if (text.starts_with("\xABKTX")) {
        return "KTX 1";
    }
    return text.size() >= 12 && text.substr(4).starts_with("ftypavif") ? "AVIF" : "";
}

}  // namespace glint::gltf

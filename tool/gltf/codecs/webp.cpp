// Decodes WebP images (EXT_texture_webp).
#include "gltf/codecs/codecs.h"

#include <webp/decode.h>

namespace glint::gltf {

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

bool readWebpHeader(ByteView bytes, Image& image, std::string& problem) {
    WebPBitstreamFeatures features;
    if (const VP8StatusCode code = WebPGetFeatures(bytes.data(), bytes.size(), &features);
        code != VP8_STATUS_OK) {
        problem = describe(code);
        return false;
    }
    if (features.has_animation != 0) {
        problem = "an animation, which EXT_texture_webp forbids";
        return false;
    }
    image.width = features.width;
    image.height = features.height;
    image.format = PixelFormat::Rgba8;
    return true;
}

bool decodeWebp(ByteView bytes, Image& image, std::string& problem) {
    const int stride = 4 * image.width;
    image.pixels.resize(static_cast<std::size_t>(stride) * static_cast<std::size_t>(image.height));
    if (WebPDecodeRGBAInto(bytes.data(), bytes.size(), image.pixels.data(), image.pixels.size(), stride) ==
        nullptr) {
        problem = "the data is damaged or ends early";
        image.pixels.clear();
        return false;
    }
    return true;
}

}  // namespace

const Codec kWebp{"WebP", "image/webp", readWebpHeader, decodeWebp};

}  // namespace glint::gltf

// Decodes KTX2 images with the transcoder of Basis Universal.
#include "gltf/codecs/basisu.h"

#include "gltf/codecs/codecs.h"
#include "gltf/codecs/ktx2.h"

#include <basisu_transcoder.h>
#include <cstddef>
#include <cstdint>
#include <string>

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
bool decode(ByteView bytes, Image& image, std::string& problem) {
    makeTables();
    // Blocks lie at multiples of 16 bytes in the file, but a buffer view may start anywhere.
    constexpr std::uintptr_t kAlignment = 16;
    base::Bytes aligned;
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % kAlignment != 0) {
        aligned.assign(bytes.begin(), bytes.end());
        bytes = aligned;
    }
    basist::ktx2_transcoder transcoder;
    if (!transcoder.init(bytes.data(), static_cast<std::uint32_t>(bytes.size())) ||
        !transcoder.start_transcoding()) {
        problem = "the transcoder of Basis Universal does not take its header or its code books";
        return false;
    }
    image.pixels.resize(byteCount(image));
    std::uint8_t* target = image.pixels.data();
    for (int level = 0; level < image.levels; ++level) {
        const auto pixels = static_cast<std::uint32_t>(pixelCount(image, level));
        if (!transcoder.transcode_image_level(static_cast<std::uint32_t>(level), 0, 0, target, pixels,
                                              basist::transcoder_texture_format::cTFRGBA32)) {
            problem = "the data of level " + std::to_string(level) + " are damaged";
            image.pixels.clear();
            return false;
        }
        target += std::size_t{4} * pixels;
    }
    return true;
}

}  // namespace

const Codec kBasisu{"KTX2", readKtx2Header, decode};

bool hasBasisu() {
    return true;
}

}  // namespace glint::gltf

// Fuzzes KTX2 and DDS images of glTF scenes, what unpacks their blocks, and the transcoder of Basis Universal
// behind them if the build has it.
#include "fuzz/fuzz_target.h"
#include "gltf/codecs/codecs.h"
#include "gltf/texels/fit.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using glint::fuzz::require;
    const glint::gltf::ByteView bytes(data, size);
    glint::gltf::Image image;
    const glint::Result<glint::gltf::BlockFile> file = glint::gltf::readBlockFile(bytes);
    if (!file) {
        require(!file.error().message.empty(), "a header that is refused has a reason");
        return 0;
    }
    require(glint::gltf::kBasisu.readHeader(bytes, image).ok(), "a file that is read has a header");
    require(image.width > 0 && image.height > 0 && image.levels > 0, "an image has a size");
    // Large images are slow to decode and show nothing that smaller ones do not.
    constexpr int kLargest = 512;
    if (image.width > kLargest || image.height > kLargest || image.layers > kLargest / 32) {
        return 0;
    }
    image.file.assign(bytes.begin(), bytes.end());
    glint::TexelFormats formats;
    for (std::uint32_t i = 0; i < glint::kTexelFormatCount; ++i) {
        formats.add(static_cast<glint::TexelFormat>(i), false);
        formats.add(static_cast<glint::TexelFormat>(i), true);
    }
    const glint::gltf::ImageUse use{false, true, false, false, 6};
    if (const auto fitted = fitImage(glint::gltf::Scene(), image, use, {.formats = formats}); fitted) {
        std::uint64_t texels = 0;
        for (int level = 0; level < fitted->levels; ++level) {
            texels += levelBytes(*fitted, fitted->format, level);
        }
        require(fitted->texels.size() == texels, "an image has the levels that it says");
    }
    if (const glint::Status status = glint::gltf::kBasisu.decode(bytes, image); !status) {
        require(!status.error().message.empty(), "an image that can't be decoded has a reason");
        return 0;
    }
    require(image.pixels.size() == glint::gltf::byteCount(image), "an image has the pixels that it says");
    return 0;
}

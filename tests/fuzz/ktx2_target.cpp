// Fuzzes KTX2 images of glTF scenes, and the transcoder of Basis Universal behind them if the build has it.
#include "fuzz/fuzz_target.h"
#include "gltf/codecs/basisu.h"
#include "gltf/codecs/codecs.h"
#include "gltf/codecs/ktx2.h"

#include <string>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using glint::fuzz::require;
    const glint::gltf::ByteView bytes(data, size);
    glint::gltf::Image image;
    std::string problem;
    if (!glint::gltf::readKtx2Header(bytes, image, problem)) {
        require(!problem.empty(), "a header that is refused has a reason");
        return 0;
    }
    require(image.width > 0 && image.height > 0 && image.levels > 0, "an image has a size");
    // Large images are slow to decode and show nothing that smaller ones do not.
    constexpr int kLargest = 512;
    if (!glint::gltf::hasBasisu() || image.width > kLargest || image.height > kLargest) {
        return 0;
    }
    if (!glint::gltf::kBasisu.decode(bytes, image, problem)) {
        require(!problem.empty(), "an image that can't be decoded has a reason");
        return 0;
    }
    require(image.pixels.size() == glint::gltf::byteCount(image), "an image has the pixels that it says");
    return 0;
}

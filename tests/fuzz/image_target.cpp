// Fuzzes the pictures that compare and --environment read. The first bytes of an input decide its format.
#include "fuzz/fuzz_target.h"
#include "image/exr.h"
#include "image/image_file.h"
#include "image/png.h"

#include <span>

namespace {

// The formats are recognised by the magic numbers of OpenEXR and PNG.
glint::Result<glint::LinearImage> decode(std::span<const std::uint8_t> bytes) {
    if (!bytes.empty() && bytes[0] == 0x76) {
        return glint::image::decodeExr(bytes, "picture.exr");
    }
    return !bytes.empty() && bytes[0] == 0x89 ? glint::image::decodePng(bytes, "picture.png")
                                              : glint::image::decodeHdr(bytes, "picture.hdr");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using glint::fuzz::require;
    const glint::Result<glint::LinearImage> image = decode({data, size});
    if (!image) {
        require(!image.error().id.empty() && !image.error().message.empty(),
                "an error has an id and a message");
        return 0;
    }
    require(image->width > 0 && image->height > 0 &&
                image->pixels.size() == std::size_t{image->width} * image->height,
            "an image has the pixels that it says");
    return 0;
}

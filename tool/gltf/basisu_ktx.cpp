// KTX2 images through libktx 4 (KTX-Software).
#include "gltf/basisu.h"
#include "gltf/codecs.h"

#include <cstdint>
#include <ktx.h>
#include <limits>
#include <memory>

namespace glint::gltf {

namespace {

// VkFormat's numbers of what needs no transcoding.
constexpr ktx_uint32_t kRgba8Unorm = 37;
constexpr ktx_uint32_t kRgba8Srgb = 43;

struct Destroy {
    void operator()(ktxTexture2* texture) const {
        ktxTexture_Destroy(ktxTexture(texture));
    }
};
using Texture = std::unique_ptr<ktxTexture2, Destroy>;

// Reads the header; image data is not loaded yet. Null, and the problem, where Glint can't read the texture.
Texture open(ByteView bytes, std::string& problem) {
    ktxTexture2* created = nullptr;
    const KTX_error_code code =
        ktxTexture2_CreateFromMemory(bytes.data(), bytes.size(), KTX_TEXTURE_CREATE_NO_FLAGS, &created);
    if (code != KTX_SUCCESS) {
        problem = ktxErrorString(code);
        return nullptr;
    }
    Texture texture(created);
    constexpr auto kLargest = static_cast<ktx_uint32_t>(std::numeric_limits<int>::max());
    if (texture->numDimensions != 2 || texture->isArray || texture->isCubemap ||
        texture->baseWidth > kLargest || texture->baseHeight > kLargest) {
        problem = "it is no single two-dimensional image";
        return nullptr;
    }
    // Loading allocates by this. A chain of mips has 4/3 of the pixels of its first, of 4 bytes at most, and
    // blocks of 4 x 4 pixels at its end.
    const std::uint64_t pixels = std::uint64_t{texture->baseWidth} * texture->baseHeight;
    if (ktxTexture_GetDataSizeUncompressed(ktxTexture(created)) / 8 > pixels + 1024) {
        problem = "it claims more data than its pixels have";
        return nullptr;
    }
    if (!ktxTexture2_NeedsTranscoding(created) && created->vkFormat != kRgba8Unorm &&
        created->vkFormat != kRgba8Srgb) {
        problem = "it holds neither Basis Universal data nor 8-bit RGBA";
        return nullptr;
    }
    return texture;
}

bool readHeader(ByteView bytes, Image& image, std::string& problem) {
    const Texture texture = open(bytes, problem);
    if (!texture) {
        return false;
    }
    image.width = static_cast<int>(texture->baseWidth);
    image.height = static_cast<int>(texture->baseHeight);
    image.format = PixelFormat::Rgba8;
    return true;
}

bool decode(ByteView bytes, Image& image, std::string& problem) {
    const Texture texture = open(bytes, problem);
    if (!texture) {
        return false;
    }
    KTX_error_code code = ktxTexture_LoadImageData(ktxTexture(texture.get()), nullptr, 0);
    if (code == KTX_SUCCESS && ktxTexture2_NeedsTranscoding(texture.get())) {
        code = ktxTexture2_TranscodeBasis(texture.get(), KTX_TTF_RGBA32, 0);
    }
    ktx_size_t offset = 0;
    if (code == KTX_SUCCESS) {
        code = ktxTexture_GetImageOffset(ktxTexture(texture.get()), 0, 0, 0, &offset);
    }
    if (code != KTX_SUCCESS) {
        problem = ktxErrorString(code);
        return false;
    }
    // Rows of a KTX2 file have no padding (KTX 2.0, 3.9.7 "levelImages").
    const std::size_t size = std::size_t{4} * texture->baseWidth * texture->baseHeight;
    const std::size_t held = ktxTexture_GetDataSize(ktxTexture(texture.get()));
    if (offset > held || size > held - offset) {
        problem = "the data ends early";
        return false;
    }
    const ktx_uint8_t* first = ktxTexture_GetData(ktxTexture(texture.get())) + offset;
    image.pixels.assign(first, first + size);
    return true;
}

}  // namespace

const Codec kBasisu{"KTX2", readHeader, decode};

bool hasBasisu() {
    return true;
}

}  // namespace glint::gltf

// Makes of an image's file what a device reads: transcoded, as it is, compressed, or unpacked.
#pragma once

#include "gltf/scene.h"
#include "gltf/texels/levels.h"

#include <glint/result.h>
#include <glint/scene_view.h>

#include <cstdint>
#include <vector>

namespace glint::gltf {

struct FitOptions {
    TexelFormats formats;         // that the device samples
    bool compress = false;        // images without block compression, too
    bool allLevels = false;       // a full pyramid for every image that levels can be made for
    bool decodeEmission = false;  // FittedImage::decoded for images that materials emit
};

// Pixels in a form that ImageView takes.
struct FittedImage : ImageShape {
    TexelFormat format = TexelFormat::Rgba8;
    TexelChannels channels = kChannelsAsStored;
    std::vector<std::uint8_t> texels{};
    std::vector<std::uint8_t> decoded{};  // the first level in RGBA8; empty unless it was asked for
};

// Returns the format that an image should be compressed to, of those that the device has for its use:
//
//   vectors               BC5 (red and green; shading finds z), BC7, ASTC 4x4
//   one channel, linear   BC4, BC7, ASTC 4x4
//   two channels, linear  BC5, BC7, ASTC 4x4
//   others                BC7, BC3 or BC1 by `hasAlpha`, ASTC 4x4
//
// Rgba8 stands for none. `packs`: only formats that packBlock() knows.
TexelFormat targetFormat(const ImageUse& use, bool hasAlpha, bool packs, const TexelFormats& formats);

// Reads an image whose pixels or file the scene has, with its layers. KTX2 of ETC1S and UASTC is transcoded
// to targetFormat(), or unpacked. KTX2 and DDS in a block format stay as they are where the device has it for
// the image's use, and are unpacked otherwise. Other images are unpacked, or compressed to targetFormat().
// The levels are those of the file. Further ones are made where a format can be packed, and for texels where
// the device's blits would not be right: for vectors, for roughness, for sides that are no powers of two, and
// with `allLevels`. None are made of 3D images, and none of these are compressed. Error "image-decode".
Result<FittedImage> fitImage(const Scene& scene, const Image& image, const ImageUse& use,
                             const FitOptions& options);

}  // namespace glint::gltf

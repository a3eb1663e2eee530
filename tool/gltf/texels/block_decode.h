// Unpacks block formats to RGBA of 8 bits on the CPU.
#pragma once

#include "gltf/document/files.h"
#include "gltf/scene.h"

#include <glint/result.h>
#include <glint/scene_view.h>

#include <cstdint>

namespace glint::gltf {

// Returns width * height pixels of a level, row by row from the top; `blocks` has bytesOfLevel() bytes. A
// colour that the format lacks is 0, and alpha 1, as a shader reads them. `srgb`: colours are in sRGB, and
// stay so. The error says that this build lacks what BC7 and ASTC need (hasBasisu()).
Result<base::Bytes> decodeBlocks(TexelFormat format, bool srgb, std::uint32_t width, std::uint32_t height,
                                 ByteView blocks);

}  // namespace glint::gltf

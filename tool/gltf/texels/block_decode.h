// Unpacks block formats to RGBA of 8 bits on the CPU.
#pragma once

#include "gltf/document/files.h"
#include "gltf/scene.h"

#include <glint/scene_view.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glint::gltf {

// Returns width * height pixels of a level, row by row from the top; `blocks` has bytesOfLevel() bytes. A
// colour that the format lacks is 0, and alpha 1, as a shader reads them. `srgb`: colours are in sRGB, and
// stay so. Returns nothing if this build lacks what BC7 and ASTC need (hasBasisu()), and `problem` says so.
std::optional<std::vector<std::uint8_t>> decodeBlocks(TexelFormat format, bool srgb, std::uint32_t width,
                                                      std::uint32_t height, ByteView blocks,
                                                      std::string& problem);

}  // namespace glint::gltf

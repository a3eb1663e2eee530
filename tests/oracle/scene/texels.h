// How a device decodes sRGB texels: a picture of all 256 of them.
#pragma once

#include "oracle/scene/texture.h"

#include <glint/renderer.h>
#include <glint/result.h>

#include <filesystem>

namespace glint::oracle {

// Writes texels.gltf, texels.bin and texels.png into an existing folder: an unlit square that fills the image
// of its camera. At 16x16 pixels the one at (x, y) shows the texel x + 16 y. Error "file-write".
Status writeTexelScene(const std::filesystem::path& folder);

// Of a picture of that scene. Error "oracle-texels" where it is of another size, or falls anywhere.
Result<SrgbTable> texelsOf(const LinearImage& picture, const std::string& where);

}  // namespace glint::oracle

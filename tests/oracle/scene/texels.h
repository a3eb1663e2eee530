// Finds how a device decodes sRGB texels, with a picture of all 256 of them.
#pragma once

#include "oracle/scene/texture.h"

#include <glint/renderer.h>
#include <glint/result.h>

#include <filesystem>

namespace glint::oracle {

// Writes texels.gltf, texels.bin and texels.png into an existing folder: an unlit square that fills the image
// of its camera. In a picture of 16x16 pixels, the pixel (x, y) shows the texel x + 16 y. Error "file-write".
Status writeTexelScene(const std::filesystem::path& folder);

// Reads the table from a picture of that scene. Error "oracle-texels" if the picture has another size, or if
// the values decrease anywhere.
Result<SrgbTable> texelsOf(const LinearImage& picture, const std::string& where);

}  // namespace glint::oracle

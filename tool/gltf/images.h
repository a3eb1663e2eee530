// Images: which can be used, and their pixels.
#pragma once

#include "gltf/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

namespace glint::gltf {

// Whether Glint can decode the image, by its type and its file's name; opens nothing.
bool isDecodableImage(const Document& document, int image);

// The image's name, and its pixels where ImportOptions::decodeImages. 16 bits become 8.
// Errors: "image-data" (no or two sources), "image-decode", "image-size", those of reading.
Result<Image> importImage(Document& document, int image);

}  // namespace glint::gltf

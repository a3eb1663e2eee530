// Images: which can be used, and their pixels.
#pragma once

#include "gltf/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <cstdint>

namespace glint::gltf {

enum class Decodable : std::uint8_t {
    Yes,
    No,
    NeedsBasisu,  // a KTX2 image, in a build without hasBasisu()
};

// Whether Glint can decode the image, by its type and its file's name; opens nothing.
Decodable decodability(const Document& document, int image);

// The image's name, and its pixels where ImportOptions::decodeImages.
// Errors: "image-data" (no or two sources), "image-decode", "image-size", those of reading.
Result<Image> importImage(Document& document, int image);

}  // namespace glint::gltf

// Finds which images can be used, and reads their pixels.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <cstdint>

namespace glint::gltf {

enum class Decodable : std::uint8_t {
    Yes,
    No,
    NeedsBasisu,  // a KTX2 image, in a build without hasBasisu()
};

// Returns whether Glint can decode the image, judging by its type and the name of its file. It opens no file.
Decodable decodability(const Document& document, int image);

// Reads the image's name, and its pixels or its file if ImportOptions ask for them. Errors: "image-data" (no
// source or two), "image-decode", "image-size", and those of reading files. If only
// ImportOptions::trustTextures asks for the file, an image that can't be read is no error, but a note, and
// has no file.
Result<Image> importImage(Document& document, int image);

// Turns the error of an image into the note that nothing is known of its texels.
Diagnostic unknownTexels(const Diagnostic& error);

// Fills the pixels of an image of the scene that has its file. Error "image-decode".
Status decodeFile(const Scene& scene, Image& image);

}  // namespace glint::gltf

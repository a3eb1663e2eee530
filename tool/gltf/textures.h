// Imports the textures and samplers that materials use, in the order of first use, and their images.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace glint::gltf {

// Fills scene.samplers with the samplers of the file, in the file's order.
void importSamplers(Document& document, Scene& scene);

class TextureTable {
public:
    TextureTable(Document& document, Scene& scene);

    // Returns the index into scene.textures of the file's texture, which is appended on first use. Returns -1
    // with a warning if its source is missing or has a format that Glint does not read. The error is
    // "texture-basisu" if this build does not decode KTX2, and the texture has no fallback or the file
    // requires the extension.
    Result<int> use(int texture);

private:
    Result<int> append(int texture);
    Result<int> chooseImage(int texture);
    Result<int> useImage(int image);

    Document& document_;
    Scene& scene_;
    std::vector<std::optional<int>> textures_;  // by the file's index
    std::vector<std::optional<int>> images_;
    std::optional<int> defaultSampler_;
};

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

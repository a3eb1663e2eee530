// Imports the textures and samplers that materials use, in the order of first use, and their images.
#pragma once

#include "gltf/codecs/codecs.h"
#include "gltf/document/document.h"
#include "gltf/scene.h"
#include "gltf/texels/levels.h"

#include <glint/result.h>

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
    // Returns the image of scene.textures[texture].
    const Image& imageOf(int texture) const;

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

// Returns the error of an image that its codec refuses. `fault` is the codec's.
Diagnostic cantDecode(const Scene& scene, const Image& image, const Codec& codec, const Diagnostic& fault);

// Turns the error of an image into the note that nothing is known of its texels.
Diagnostic unknownTexels(const Diagnostic& error);

// Returns the texels of an image of the scene, which has its pixels or its file. Error "image-decode".
Result<Texels> texelsOf(const Scene& scene, const Image& image);

}  // namespace glint::gltf

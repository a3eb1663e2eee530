// Textures and samplers: those that materials use, in the order of first use.
#pragma once

#include "gltf/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <optional>
#include <vector>

namespace glint::gltf {

// scene.samplers: those of the file, in its order.
void importSamplers(Document& document, Scene& scene);

class TextureTable {
public:
    TextureTable(Document& document, Scene& scene);

    // Index into scene.textures of the file's texture, appended on first use; -1 and a warning where its
    // source is missing or of a format that Glint does not read. Error "texture-basisu": it is KTX2 without a
    // fallback, or the file requires that, and this build does not decode it.
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

}  // namespace glint::gltf

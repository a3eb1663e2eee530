// Reads the images of a Scene in the formats that a device has.
#pragma once

#include "gltf/scene.h"
#include "gltf/texels/fit.h"

#include <glint/context.h>
#include <glint/result.h>
#include <glint/session/scene_view.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace glint::compiler {
class CacheStore;
}  // namespace glint::compiler

namespace glint::session {

struct TextureOptions {
    gltf::FitOptions fit;
    // Keeps images that were compressed, by their files' contents; null: they are compressed each time.
    compiler::CacheStore* cache = nullptr;
    std::uint32_t threads = 0;  // 0: one for each core
};

// One image for each of Scene::images.
struct TextureSet {
    std::vector<gltf::FittedImage> images;
    std::uint32_t found = 0;    // in the cache
    double milliseconds = 0.0;  // wall clock
    // The reasons why --compress-textures changes nothing.
    std::vector<Diagnostic> notes;
};

// Reads all images of a scene that was imported with ImportOptions::keepImageFiles or decodeImages, on
// several threads. An image that no material reads counts as colour. Error "image-decode" of the first image
// that can't be read.
Result<std::shared_ptr<const TextureSet>> loadTextures(const gltf::Scene& scene,
                                                       const TextureOptions& options);

// Gives the images to `data`, which keeps them.
void useTextures(std::shared_ptr<const TextureSet> textures, SceneViewData& data);
// Adds the images of another scene behind those that are there.
void addTextures(std::shared_ptr<const TextureSet> textures, SceneViewData& data);

}  // namespace glint::session

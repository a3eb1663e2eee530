// The state of a TextureStream: the textures whose levels it brings.
#pragma once

#include "context/upload.h"
#include "data/materials.h"
#include "data/retired.h"
#include "scene/gpu_scene_state.h"

#include <glint/scene.h>

#include <cstdint>
#include <map>
#include <memory>

namespace glint {

// A texture with levels that are not on the device.
struct StreamedTexture {
    StoredImage image;
    std::uint32_t level = 0;   // the finest that is complete
    std::uint32_t row = 0;     // of the next finer one: the first row of blocks that is missing
    std::uint32_t finest = 0;  // the finest level that may be brought

    bool waits() const {
        return level > finest;
    }
};

struct TextureStream::State {
    State(GpuScene::State& owner, std::uint32_t firstTexels)
        : scene(owner),
          firstSize(firstTexels),
          uploader(std::make_unique<Uploader>(owner.context, owner.brief)) {}

    GpuScene::State& scene;
    std::uint32_t firstSize;                            // texels a side of the finest level that uploads take
    std::map<std::uint32_t, StreamedTexture> textures;  // by number
    Retired retired;
    std::unique_ptr<Uploader> uploader;
    std::uint64_t lastFrame = 0;
};

// Makes the image of a texture whose number will be `texture`. If it has all of its levels and some of them
// are larger than the stream's first size, only the others are copied, by `uploader`, and the stream gets the
// rest.
Result<DeviceImage> uploadStreamed(TextureStream::State& stream, Uploader& uploader, std::uint32_t texture,
                                   const ImageView& image, bool srgb);
// Makes an image with the given levels, which is streamed if the scene streams.
Result<DeviceImage> uploadSceneTexture(GpuScene::State& scene, Uploader& uploader, std::uint32_t texture,
                                       const ImageView& image, bool srgb);
// Forgets a texture whose image is replaced or removed.
void forgetTexture(GpuScene::State& scene, std::uint32_t texture);

}  // namespace glint

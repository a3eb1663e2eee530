// Bindless textures and samplers.
#pragma once

#include "interop/scene.h"
#include "resources.h"
#include "upload.h"

#include <glint/package.h>
#include <glint/scene_view.h>

#include <span>
#include <vector>

namespace glint {

// One image a TextureEntry, in its order, all mips; at least one, so that the array is never empty.
// 16-bit images become 16-bit linear textures, where the device can use those. Copies are queued in
// `uploader`. Error "scene-textures": more than a shader of this device can see.
Result<std::vector<DeviceImage>> uploadTextures(Context::State& context, MemoryPool& pool, Uploader& uploader,
                                                std::span<const package::TextureEntry> textures,
                                                std::span<const ImageView> images);

// Of those textures, how many uploadTextures() narrowed from 16 bits to 8.
std::uint32_t countNarrowed(const Context::State& context, std::span<const package::TextureEntry> textures,
                            std::span<const ImageView> images);

// The package's materials with the sizes of their textures and the anisotropy of their samplers, which
// texture gradients need: a size query in a shader is a fetch of its own, and lavapipe answers it for one
// lane where the index differs. Requires an image for each texture.
std::vector<gpu::MaterialRecord> materialsWithSizes(const Context::State& context, const PackageScene& known,
                                                    std::span<const ImageView> images);

// One sampler a SamplerEntry; at least one. Error "scene-samplers".
Result<std::vector<UniqueSampler>> createSamplers(Context::State& context,
                                                  std::span<const package::SamplerEntry> samplers);

}  // namespace glint

// Bindless textures and samplers.
#pragma once

#include "context/resources.h"
#include "context/upload.h"
#include "interop/scene.h"

#include <glint/package.h>
#include <glint/scene_view.h>

#include <array>
#include <span>
#include <vector>

namespace glint {

// The texture of a slot without a texture. White leaves a factor unchanged.
inline constexpr std::uint8_t kWhiteTexel[] = {255, 255, 255, 255};

// Texels in the format that the device stores.
struct StoredImage {
    std::vector<std::uint8_t> converted;  // holds the view's texels if they are not the caller's
    ImageView view;
    bool srgb = false;
};
// Images of 16 bits become linear, because mips must be blitted from linear values and 16 bits have no format
// in sRGB, or are narrowed to 8 bits if the device can't use them. Blits of sRGB formats decode and encode
// them.
StoredImage storedImage(const Context::State& context, const ImageView& image, bool srgb);

// Returns the image of a texture, with the mips that ImageView says. Blits need texels as they are.
ImageInfo textureInfo(const ImageView& image, bool srgb);
// Returns a level that the image has.
std::span<const std::uint8_t> texelsOfLevel(const ImageView& image, std::uint32_t level);

// Makes an image with these mips. Queues the copies in `uploader`.
Result<DeviceImage> uploadTexture(Context::State& context, MemoryPool& pool, Uploader& uploader,
                                  const ImageView& image, bool srgb);

Result<UniqueSampler> createSampler(Context::State& context, const package::SamplerEntry& entry);
// Returns the maximum anisotropy of that sampler.
float anisotropyOf(const Context::State& context, const package::SamplerEntry& entry);

// Error "scene-textures": there are more textures than a shader of this device can see.
Status checkTextureCount(const Context::State& context, std::size_t count);

// Returns how many of those textures are narrowed from 16 bits to 8.
std::uint32_t countNarrowed(const Context::State& context, std::span<const package::TextureEntry> textures,
                            std::span<const ImageView> images);

// Returns the package's materials with the sizes of their textures and the anisotropy of their samplers,
// which texture gradients need. A size query in a shader would be a fetch of its own, and lavapipe answers it
// for one lane even if lanes differ in the index. Requires an image for each texture.
std::vector<std::uint8_t> materialsWithSizes(const Context::State& context, const PackageScene& known,
                                             std::span<const ImageView> images);
// Does the same for textures of these sizes.
std::vector<std::uint8_t> materialsWithSizes(const Context::State& context, const PackageScene& known,
                                             std::span<const std::array<float, 2>> texels);

// Makes one sampler for each SamplerEntry, and at least one. Error "scene-samplers".
Result<std::vector<UniqueSampler>> createSamplers(Context::State& context,
                                                  std::span<const package::SamplerEntry> samplers);

}  // namespace glint

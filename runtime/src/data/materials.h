// Bindless textures and samplers, and the records of materials.
#pragma once

#include "context/resources.h"
#include "context/upload.h"
#include "interop/scene.h"

#include <glint/package.h>
#include <glint/result.h>
#include <glint/scene_view.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
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

// The electro-optical transfer function of IEC 61966-2-1.
double decodeSrgb(double encoded);

// Converts RGBA in sRGB of 16 bits a channel, native byte order, to linear values of 16 bits, because Vulkan
// has no 16-bit sRGB format. A step of the result is 1.5e-5 and the darkest step of 8-bit sRGB is 3.0e-4, so
// no difference is visible. Alpha is linear already. Requires 8 bytes a texel.
std::vector<std::uint8_t> linearizeRgba16(std::span<const std::uint8_t> texels);

// Converts RGBA of 16 bits a channel to the nearest values of 8 bits, in the same transfer function.
std::vector<std::uint8_t> narrowRgba16(std::span<const std::uint8_t> texels);

// A field or a texture of the records of a package.
struct RecordField {
    std::string name;
    std::uint32_t offset = 0;  // bytes
    std::uint32_t bytes = 0;
    std::uint32_t model = 0;  // whose records have it, as in keys
    std::uint32_t type = 0;   // FieldEntry::type
};
// The fields of a scene's records, which the package need not outlive.
struct RecordFields {
    std::vector<RecordField> list;
    std::vector<std::uint32_t> models;  // of the scene's materials, as in keys

    std::uint32_t modelOf(std::uint32_t material) const {
        return material < models.size() ? models[material] : 0;
    }
    // Returns the field of that name in records of the model, or null.
    const RecordField* find(std::string_view name, std::uint32_t model) const;
    // Returns the field or the texture that records of the model have there, or null.
    const RecordField* findAt(std::size_t offset, std::uint32_t model) const;
    bool hasAt(std::size_t offset, std::uint32_t model) const {
        return findAt(offset, model) != nullptr;
    }
};
RecordFields recordFields(const Package& package, const PackageScene& known);

// Copies what a record of the layout `from` has of the fields and textures of the layout `to`. The others
// stay as they are in `record`. Each layout knows the record's model by its own number.
void carryFields(const RecordFields& from, std::uint32_t modelBefore, std::span<const std::uint8_t> values,
                 const RecordFields& to, std::uint32_t model, std::span<std::uint8_t> record);

// A material of SceneView::materials with its values on the device.
struct ChangingMaterial {
    std::uint32_t material = 0;
    std::vector<std::uint8_t> record;
};

// Takes all values except the choice of textures and samplers, their sizes and UV sets. `values` and `record`
// are records of the layout of `table`, whose own records are not read.
void takeValues(std::span<const std::uint8_t> values, const MaterialTable& table,
                std::span<std::uint8_t> record);

// Writes the values of `views` into the records that they name; `records` has the bytes of `table`, which
// gives their layout. Each record keeps its textures and samplers, which the host can't name. Error
// "scene-material": a material does not exist, is out of order or has another size.
Result<std::vector<ChangingMaterial>> replaceMaterials(std::span<const MaterialView> views,
                                                       const MaterialTable& table,
                                                       std::span<std::uint8_t> records);

// Takes the values of an update, which must name the same materials. On error "scene-material", `changing`
// stays as it was.
Status takeMaterials(std::span<const MaterialView> views, const MaterialTable& table,
                     std::span<ChangingMaterial> changing);

}  // namespace glint

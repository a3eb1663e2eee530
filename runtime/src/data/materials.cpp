#include "data/materials.h"

#include "context/context.h"
#include "context/vulkan_table.h"
#include "package/package.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>

namespace glint {
namespace {

constexpr double kLargest16 = 65535.0;

std::vector<std::uint16_t> makeLinearTable() {
    std::vector<std::uint16_t> table(65536);
    for (std::size_t i = 0; i < table.size(); ++i) {
        table[i] = static_cast<std::uint16_t>(
            std::lround(decodeSrgb(static_cast<double>(i) / kLargest16) * kLargest16));
    }
    return table;
}

}  // namespace

double decodeSrgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

std::vector<std::uint8_t> linearizeRgba16(std::span<const std::uint8_t> texels) {
    const std::vector<std::uint16_t> table = makeLinearTable();
    std::vector<std::uint8_t> linear(texels.begin(), texels.end());
    for (std::size_t i = 0; i + 8 <= linear.size(); i += 8) {
        std::uint16_t color[3];
        std::memcpy(color, &linear[i], sizeof color);
        for (std::uint16_t& channel : color) {
            channel = table[channel];
        }
        std::memcpy(&linear[i], color, sizeof color);
    }
    return linear;
}

std::vector<std::uint8_t> narrowRgba16(std::span<const std::uint8_t> texels) {
    std::vector<std::uint8_t> narrow(texels.size() / 2);
    for (std::size_t i = 0; i < narrow.size(); ++i) {
        std::uint16_t channel = 0;
        std::memcpy(&channel, &texels[2 * i], sizeof channel);
        // 65535 = 255 * 257, and adding 128 rounds to the nearest.
        narrow[i] = static_cast<std::uint8_t>((channel + 128U) / 257U);
    }
    return narrow;
}

StoredImage storedImage(const Context::State& context, const ImageView& image, bool srgb) {
    StoredImage stored{{}, image, srgb};
    if (image.format != TexelFormat::Rgba16) {
        return stored;
    }
    if (!context.limits.wideTextures) {
        stored.converted = narrowRgba16(image.pixels);
        stored.view.format = TexelFormat::Rgba8;
    } else if (srgb) {
        stored.converted = linearizeRgba16(image.pixels);
    }
    stored.srgb = srgb && !context.limits.wideTextures;
    if (!stored.converted.empty()) {
        stored.view.pixels = stored.converted;
    }
    return stored;
}

ImageInfo textureInfo(const ImageView& image, bool srgb) {
    ImageInfo info;
    info.format = vulkanFormat(image.format, srgb);
    info.extent = {image.width, image.height};
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (isBlockFormat(image.format)) {
        info.mips = image.levels;
    } else {
        info.mips = image.mostLevels();
        info.usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    }
    info.components = vulkanComponents(image.channels);
    info.dimension = image.dimension;
    info.layers = image.layers;
    return info;
}

std::span<const std::uint8_t> texelsOfLevel(const ImageView& image, std::uint32_t level) {
    return image.pixels.subspan(image.byteCount(level), image.bytesAt(level));
}

Result<DeviceImage> uploadTexture(Context::State& context, MemoryPool& pool, Uploader& uploader,
                                  const ImageView& image, bool srgb) {
    const StoredImage stored = storedImage(context, image, srgb);
    GLINT_TRY(auto texture, createImage(context, pool, textureInfo(stored.view, stored.srgb)));
    std::vector<std::span<const std::uint8_t>> mips;
    for (std::uint32_t level = 0; level < stored.view.levels; ++level) {
        mips.push_back(texelsOfLevel(stored.view, level));
    }
    GLINT_TRY_DO(uploader.copyToImage(mips, blockOf(stored.view.format), texture));
    return texture;
}

namespace {

VkSamplerAddressMode addressMode(std::uint32_t wrap) {
    constexpr VkSamplerAddressMode kModes[] = {VK_SAMPLER_ADDRESS_MODE_REPEAT,
                                               VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                               VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT};
    return kModes[wrap];
}

VkFilter filter(std::uint32_t linear) {
    return linear != 0 ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
}

}  // namespace

// A file that requests nearest texels, or no mips, gets no anisotropic filter.
float anisotropyOf(const Context::State& context, const package::SamplerEntry& entry) {
    const bool isTrilinear = entry.minification != 0 && entry.mipmapped != 0 && entry.mip != 0;
    return isTrilinear ? context.limits.samplerAnisotropy : 1.0F;
}

Result<UniqueSampler> createSampler(Context::State& context, const package::SamplerEntry& entry) {
    VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                             .magFilter = filter(entry.magnification),
                             .minFilter = filter(entry.minification),
                             .addressModeU = addressMode(entry.wrapU),
                             .addressModeV = addressMode(entry.wrapV),
                             .addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT};
    if (entry.mipmapped != 0) {
        info.mipmapMode = entry.mip != 0 ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
        info.maxLod = VK_LOD_CLAMP_NONE;
    } else {
        // Only mip 0 is used. The limit is above 0, so that minification still uses its own filter
        // (VkSamplerCreateInfo, note).
        info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
        info.maxLod = 0.25F;
    }
    info.maxAnisotropy = anisotropyOf(context, entry);
    info.anisotropyEnable = info.maxAnisotropy > 1.0F ? VK_TRUE : VK_FALSE;
    return createHandle<UniqueSampler>(context, context.vk.CreateSampler, "vkCreateSampler", info);
}

Status checkTextureCount(const Context::State& context, std::size_t count) {
    if (count > context.limits.maxTextures) {
        return makeError(
            "scene-textures", "",
            phrase("the scene has ", count, " textures, the device takes ", context.limits.maxTextures),
            "use a smaller scene");
    }
    return okStatus();
}

std::uint32_t countNarrowed(const Context::State& context, std::span<const package::TextureEntry> textures,
                            std::span<const ImageView> images) {
    if (context.limits.wideTextures) {
        return 0;
    }
    return static_cast<std::uint32_t>(
        std::ranges::count_if(textures, [&](const package::TextureEntry& texture) {
            return images[texture.image].format == ImageView::Format::Rgba16;
        }));
}

std::vector<std::uint8_t> materialsWithSizes(const Context::State& context, const PackageScene& known,
                                             std::span<const ImageView> images) {
    std::vector<std::array<float, 2>> texels;
    for (const package::TextureEntry& texture : known.textures) {
        const ImageView& image = images[texture.image];
        texels.push_back({static_cast<float>(image.width), static_cast<float>(image.height)});
    }
    return materialsWithSizes(context, known, texels);
}

std::vector<std::uint8_t> materialsWithSizes(const Context::State& context, const PackageScene& known,
                                             std::span<const std::array<float, 2>> texels) {
    std::vector<std::uint8_t> bytes(known.materials.bytes.begin(), known.materials.bytes.end());
    const std::span<const package::SamplerEntry> samplers = known.samplers;
    for (std::size_t i = 0; i < known.materials.size(); ++i) {
        for (std::uint32_t slot = 0; slot < known.materials.textureCount; ++slot) {
            gpu::TextureRecord record = textureAt(known.materials, i, slot);
            if (record.textureIndex < texels.size()) {
                record.texels = {texels[record.textureIndex][0], texels[record.textureIndex][1]};
            }
            record.anisotropy = record.samplerIndex < samplers.size()
                                    ? anisotropyOf(context, samplers[record.samplerIndex])
                                    : 1.0F;
            std::memcpy(&bytes[placeOfTexture(known.materials, i, slot)], &record, sizeof record);
        }
    }
    return bytes;
}

Result<std::vector<UniqueSampler>> createSamplers(Context::State& context,
                                                  std::span<const package::SamplerEntry> samplers) {
    const std::uint32_t limit =
        std::min(context.limits.maxSamplers, context.limits.core.maxSamplerAllocationCount);
    if (samplers.size() > limit) {
        return makeError("scene-samplers", "",
                         phrase("the scene has ", samplers.size(), " samplers, the device takes ", limit),
                         "use fewer kinds of samplers");
    }
    constexpr package::SamplerEntry kDefault{0, 0, 1, 1, 1, 1};
    const std::span<const package::SamplerEntry> wanted =
        samplers.empty() ? std::span(&kDefault, 1) : samplers;
    std::vector<UniqueSampler> created;
    for (const package::SamplerEntry& entry : wanted) {
        GLINT_TRY(auto sampler, createSampler(context, entry));
        created.push_back(std::move(sampler));
    }
    return created;
}

namespace {

Diagnostic fault(const MaterialView& view, const char* what) {
    return makeError("scene-material", "material " + std::to_string(view.material), what,
                     "give records of the package's materials, by ascending number, the same at each update");
}

}  // namespace

const RecordField* RecordFields::find(std::string_view name, std::uint32_t model) const {
    const auto found = std::ranges::find_if(
        list, [&](const RecordField& field) { return field.name == name && field.model == model; });
    return found == list.end() ? nullptr : &*found;
}

const RecordField* RecordFields::findAt(std::size_t offset, std::uint32_t model) const {
    const auto found = std::ranges::find_if(
        list, [&](const RecordField& field) { return field.offset == offset && field.model == model; });
    return found == list.end() ? nullptr : &*found;
}

RecordFields recordFields(const Package& package, const PackageScene& known) {
    RecordFields fields;
    for (const package::FieldEntry& entry : package.fields()) {
        fields.list.push_back(
            {std::string(package.string(entry.name)), entry.offset, entry.bytes, entry.model, entry.type});
    }
    fields.models.resize(known.materials.size());
    for (const package::PrimitiveEntry& entry : known.primitives) {
        fields.models[entry.materialIndex] = entry.key.model;
    }
    return fields;
}

void carryFields(const RecordFields& from, std::uint32_t modelBefore, std::span<const std::uint8_t> values,
                 const RecordFields& to, std::uint32_t model, std::span<std::uint8_t> record) {
    for (const RecordField& field : to.list) {
        const RecordField* const same = field.model == model ? from.find(field.name, modelBefore) : nullptr;
        if (same != nullptr && same->bytes == field.bytes && same->type == field.type) {
            std::memcpy(&record[field.offset], &values[same->offset], field.bytes);
        }
    }
}

void takeValues(std::span<const std::uint8_t> values, const MaterialTable& table,
                std::span<std::uint8_t> record) {
    std::vector<std::uint8_t> taken(values.begin(), values.end());
    const MaterialTable given = tableWith(table, values);
    const MaterialTable kept = tableWith(table, record);
    for (std::uint32_t slot = 0; slot < table.textureCount; ++slot) {
        const gpu::TextureRecord wanted = textureAt(given, 0, slot);
        gpu::TextureRecord texture = textureAt(kept, 0, slot);
        texture.rowU = wanted.rowU;
        texture.rowV = wanted.rowV;
        std::memcpy(&taken[placeOfTexture(given, 0, slot)], &texture, sizeof texture);
    }
    std::ranges::copy(taken, record.begin());
}

Result<std::vector<ChangingMaterial>> replaceMaterials(std::span<const MaterialView> views,
                                                       const MaterialTable& table,
                                                       std::span<std::uint8_t> records) {
    std::vector<ChangingMaterial> changing;
    for (const MaterialView& view : views) {
        if (view.material >= table.size()) {
            return fault(view, "the package has no such material");
        }
        if (!changing.empty() && changing.back().material >= view.material) {
            return fault(view, "the materials are not sorted, or one is there twice");
        }
        if (view.record.size() != table.recordBytes) {
            return fault(view, "the record has another size than the package's");
        }
        const std::span<std::uint8_t> record =
            records.subspan(std::size_t{view.material} * table.recordBytes, table.recordBytes);
        takeValues(view.record, table, record);
        changing.push_back({view.material, {record.begin(), record.end()}});
    }
    return changing;
}

Status takeMaterials(std::span<const MaterialView> views, const MaterialTable& table,
                     std::span<ChangingMaterial> changing) {
    if (views.size() != changing.size()) {
        return makeError("scene-material", "",
                         phrase("the update has ", views.size(), " materials, the scene was uploaded with ",
                                changing.size()),
                         "give records of the same materials at each update");
    }
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (views[i].material != changing[i].material || views[i].record.size() != table.recordBytes) {
            return fault(views[i],
                         "the update names another material than the upload, or its record has another size");
        }
    }
    for (std::size_t i = 0; i < views.size(); ++i) {
        takeValues(views[i].record, table, changing[i].record);
    }
    return okStatus();
}

}  // namespace glint

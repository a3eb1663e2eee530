#include "emit/tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace glint {

using package::TextureEntry;

namespace {

// Rows of translation * rotation * scale. The rotation is counter-clockwise as seen on the image, where v
// points down; the extension's GLSL listing turns the other way, its text and test models this one
// (KhronosGroup/glTF issue 1563).
void setTransform(const TextureTransform& transform, gpu::TextureRecord& record) {
    const double sine = std::sin(static_cast<double>(transform.rotation));
    const double cosine = std::cos(static_cast<double>(transform.rotation));
    const double scaleU = transform.scale[0];
    const double scaleV = transform.scale[1];
    record.rowU = {static_cast<float>(cosine * scaleU), static_cast<float>(sine * scaleV),
                   transform.offset[0]};
    record.rowV = {static_cast<float>(-sine * scaleU), static_cast<float>(cosine * scaleV),
                   transform.offset[1]};
}

gpu::vec3 toVec3(const std::array<float, 3>& values) {
    return {values[0], values[1], values[2]};
}

// Returns the absorption along a path, per metre (KHR_materials_volume, Beer-Lambert law):
// transmittance = color^(length / distance) = exp(-absorption * length).
gpu::vec3 absorptionOf(const Volume& volume) {
    // A coefficient above this lets no visible light through (black absorbs without limit). Its product with
    // the length of any scene, which is below 1e18 m, is finite.
    constexpr double kMaxAbsorption = 1e18;
    std::array<float, 3> absorption{};
    if (volume.attenuationDistance > 0.0F) {
        for (std::size_t i = 0; i < absorption.size(); ++i) {
            const double coefficient = -std::log(static_cast<double>(volume.attenuationColor[i])) /
                                       static_cast<double>(volume.attenuationDistance);
            // max() turns the -0 of white, -log(1), into 0.
            absorption[i] = static_cast<float>(std::min(std::max(0.0, coefficient), kMaxAbsorption));
        }
    }
    return toVec3(absorption);
}

void setExtensions(const Material& material, gpu::MaterialRecord& record) {
    const bool glossy = material.specularGlossiness.given;
    record.glossinessFactor = material.specularGlossiness.glossinessFactor;
    record.specularColorFactor =
        toVec3(glossy ? material.specularGlossiness.specularFactor : material.specular.colorFactor);
    record.specularFactor = material.specular.factor;
    record.ior = material.ior.ior;
    record.clearcoatFactor = material.clearcoat.factor;
    record.clearcoatRoughnessFactor = material.clearcoat.roughnessFactor;
    record.clearcoatNormalScale = material.clearcoat.normalScale;
    record.sheenColorFactor = toVec3(material.sheen.colorFactor);
    record.sheenRoughnessFactor = material.sheen.roughnessFactor;
    const double rotation = material.anisotropy.rotation;
    record.anisotropyDirection = {static_cast<float>(std::cos(rotation)),
                                  static_cast<float>(std::sin(rotation))};
    record.anisotropyStrength = material.anisotropy.strength;
    record.iridescenceFactor = material.iridescence.factor;
    record.iridescenceIor = material.iridescence.ior;
    record.iridescenceThicknessMinimum = material.iridescence.thicknessMinimum;
    record.iridescenceThicknessMaximum = material.iridescence.thicknessMaximum;
    record.transmissionFactor = material.transmission.factor;
    record.diffuseTransmissionFactor = material.diffuseTransmission.factor;
    record.diffuseTransmissionColorFactor = toVec3(material.diffuseTransmission.colorFactor);
    record.thicknessFactor = material.volume.thicknessFactor;
    record.absorption = absorptionOf(material.volume);
    record.dispersion = material.dispersion.dispersion;
}

}  // namespace

gpu::MaterialRecord makeMaterialRecord(const Material& material) {
    gpu::MaterialRecord record{};
    const auto& base = material.baseColorFactor;
    record.baseColorFactor = {base[0], base[1], base[2], base[3]};
    record.emissiveFactor = toVec3(material.emissiveFactor);
    record.emissiveStrength = material.emissiveStrength;
    record.metallicFactor = material.metallicFactor;
    record.roughnessFactor = material.roughnessFactor;
    record.normalScale = material.normalScale;
    record.occlusionStrength = material.occlusionStrength;
    record.alphaCutoff = material.alphaCutoff;
    setExtensions(material, record);
    for (std::size_t slot = 0; slot < kTextureSlots; ++slot) {
        if (material.textures[slot].texture >= 0) {
            setTransform(material.textures[slot].transform, record.textures[slot]);
        }
    }
    return record;
}

MaterialTables makeMaterialTables(const Scene& scene) {
    MaterialTables tables;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> indexOf;
    for (const Material& material : scene.materials) {
        gpu::MaterialRecord record = makeMaterialRecord(material);
        for (std::size_t slot = 0; slot < kTextureSlots; ++slot) {
            const TextureInfo& info = material.textures[slot];
            if (info.texture < 0) {
                continue;
            }
            const Texture& texture = scene.textures[info.texture];
            const TextureEntry entry{static_cast<std::uint32_t>(texture.image),
                                     isColor(material, static_cast<TextureSlot>(slot)) ? 1U : 0U};
            const auto [place, isNew] = indexOf.try_emplace(
                {entry.image, entry.srgb}, static_cast<std::uint32_t>(tables.textures.size()));
            if (isNew) {
                tables.textures.push_back(entry);
            }
            record.textures[slot].textureIndex = place->second;
            record.textures[slot].samplerIndex = static_cast<std::uint32_t>(texture.sampler);
            record.textures[slot].texCoord = static_cast<std::uint32_t>(info.texCoord);
        }
        tables.materials.push_back(record);
    }
    return tables;
}

}  // namespace glint

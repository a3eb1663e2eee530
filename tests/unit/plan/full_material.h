// A material and a primitive that have every feature with values that are not neutral. Tests remove one and
// check which features are dropped.
#pragma once

#include "plan/plan.h"

#include <string>
#include <utility>
#include <vector>

namespace glint::testing {

using Dropped = std::vector<std::pair<std::string, std::string>>;

inline constexpr KeyOptions kTested{AlphaPolicy::Tested};

// Returns a primitive with every attribute, so that the material alone decides.
inline PrimitiveInputs fullPrimitive() {
    PrimitiveInputs primitive;
    primitive.hasNormals = true;
    primitive.hasTangents = true;
    primitive.hasTexCoords0 = true;
    primitive.hasTexCoords1 = true;
    primitive.colors = ColorContent::Varying;
    return primitive;
}

inline void setLobes(Material& material) {
    material.ior = {true, 1.33F};
    material.specular = {true, 0.5F, {0.5F, 1.0F, 1.5F}};
    material.clearcoat = {true, 0.5F, 0.25F, 0.75F};
    material.sheen = {true, {0.5F, 0.25F, 0.125F}, 0.5F};
    material.anisotropy = {true, 0.5F, 1.0F};
    material.iridescence = {true, 1.0F, 1.3F, 100.0F, 400.0F};
    material.transmission = {true, 0.5F};
    material.diffuseTransmission = {true, 0.5F, {1.0F, 0.5F, 0.25F}};
    material.volume = {true, 0.1F, 2.0F, {0.5F, 0.25F, 0.125F}};
    material.dispersion = {true, 0.3F};
}

// Returns a material with every feature except Unlit and SpecularGlossiness, which exclude others, and
// ClearcoatSharesNormal.
inline Material fullMaterial() {
    Material material;
    material.metallicFactor = 0.5F;
    material.roughnessFactor = 0.5F;
    material.emissiveFactor = {1.0F, 0.5F, 0.25F};
    material.emissiveStrength = 4.0F;
    material.hasEmissiveStrength = true;
    material.doubleSided = true;
    material.alphaMode = AlphaMode::Mask;
    setLobes(material);
    for (int slot = 0; slot < static_cast<int>(kTextureSlots); ++slot) {
        material.textures[slot].texture = slot;
    }
    material.texture(TextureSlot::Occlusion).texCoord = 1;
    material.texture(TextureSlot::BaseColor).transform.rotation = 0.5F;
    material.texture(TextureSlot::BaseColor).hasTransform = true;
    return material;
}

inline std::string reasonFor(const Dropped& dropped, const std::string& feature) {
    for (const auto& [name, reason] : dropped) {
        if (name == feature) {
            return reason;
        }
    }
    return {};
}

}  // namespace glint::testing

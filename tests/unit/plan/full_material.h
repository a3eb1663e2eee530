// A material and a primitive that have every feature with values that are not neutral. Tests remove one and
// check which features are dropped.
#pragma once

#include "plan/plan.h"

#include <string>
#include <utility>
#include <vector>

namespace glint::testing {

using Dropped = std::vector<std::pair<std::string, std::string>>;

inline const materials::KeyOptions kTested{package::AlphaPolicy::Tested};

// Returns a primitive with every attribute, so that the material alone decides.
inline materials::PrimitiveInputs fullPrimitive() {
    materials::PrimitiveInputs primitive;
    primitive.hasNormals = true;
    primitive.hasTangents = true;
    primitive.hasTexCoords0 = true;
    primitive.hasTexCoords1 = true;
    primitive.colors = materials::ColorContent::Varying;
    return primitive;
}

inline void setLobes(materials::Material& material) {
    material.give("KHR_materials_ior");
    material["ior"] = 1.33F;
    material.give("KHR_materials_specular");
    material["specularFactor"] = 0.5F;
    material["specularColorFactor"] = {0.5F, 1.0F, 1.5F};
    material.give("KHR_materials_clearcoat");
    material["clearcoatFactor"] = 0.5F;
    material["clearcoatRoughnessFactor"] = 0.25F;
    material["clearcoatNormalScale"] = 0.75F;
    material.give("KHR_materials_sheen");
    material["sheenColorFactor"] = {0.5F, 0.25F, 0.125F};
    material["sheenRoughnessFactor"] = 0.5F;
    material.give("KHR_materials_anisotropy");
    material["anisotropyStrength"] = 0.5F;
    material["anisotropyRotation"] = 1.0F;
    material.give("KHR_materials_iridescence");
    material["iridescenceFactor"] = 1.0F;
    material["iridescenceIor"] = 1.3F;
    material["iridescenceThicknessMinimum"] = 100.0F;
    material["iridescenceThicknessMaximum"] = 400.0F;
    material.give("KHR_materials_transmission");
    material["transmissionFactor"] = 0.5F;
    material.give("KHR_materials_diffuse_transmission");
    material["diffuseTransmissionFactor"] = 0.5F;
    material["diffuseTransmissionColorFactor"] = {1.0F, 0.5F, 0.25F};
    material.give("KHR_materials_volume");
    material["thicknessFactor"] = 0.1F;
    material["attenuationDistance"] = 2.0F;
    material["attenuationColor"] = {0.5F, 0.25F, 0.125F};
    material.give("KHR_materials_dispersion");
    material["dispersion"] = 0.3F;
}

// Returns a material with every feature except Unlit and SpecularGlossiness, which exclude others, and
// ClearcoatSharesNormal.
inline materials::Material fullMaterial() {
    materials::Material material;
    material["metallicFactor"] = 0.5F;
    material["roughnessFactor"] = 0.5F;
    material["emissiveFactor"] = {1.0F, 0.5F, 0.25F};
    material["emissiveStrength"] = 4.0F;
    material.give("KHR_materials_emissive_strength");
    material.doubleSided = true;
    material.alphaMode = materials::AlphaMode::Mask;
    setLobes(material);
    for (int slot = 0; slot < static_cast<int>(materials::builtinMaterialModel().textures.size()); ++slot) {
        material.textures[static_cast<std::size_t>(slot)].texture = slot;
    }
    material.texture("occlusionTexture").texCoord = 1;
    material.texture("baseColorTexture").transform.rotation = 0.5F;
    material.texture("baseColorTexture").hasTransform = true;
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

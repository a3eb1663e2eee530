// Rules for the JSON of a material. They check only types, because values out of range are clamped while
// reading.
#pragma once

#include "gltf/rules.h"

#include <array>
#include <limits>

namespace glint::gltf::rules {

inline constexpr std::array kTransform{numbers("offset", 2), number("rotation"), numbers("scale", 2),
                                       integer("texCoord", 0.0, kMaxInt)};
inline constexpr std::array kTextureInfoExtensions{object("KHR_texture_transform", kTransform)};
inline constexpr std::array kTextureInfo{index("index", "/textures", true), integer("texCoord", 0.0, kMaxInt),
                                         number("scale"), number("strength"),
                                         object("extensions", kTextureInfoExtensions)};
constexpr Rule texture(std::string_view name) {
    return object(name, kTextureInfo);
}

// Exporters write the largest number they know for an infinite distance. A float need not be able to hold it.
constexpr Rule distance(std::string_view name) {
    return {.name = name,
            .min = std::numeric_limits<double>::lowest(),
            .max = std::numeric_limits<double>::max()};
}

inline constexpr std::array kMetallicRoughness{numbers("baseColorFactor", 4), number("metallicFactor"),
                                               number("roughnessFactor"), texture("baseColorTexture"),
                                               texture("metallicRoughnessTexture")};
inline constexpr std::array kSpecularGlossiness{numbers("diffuseFactor", 4), texture("diffuseTexture"),
                                                numbers("specularFactor", 3), number("glossinessFactor"),
                                                texture("specularGlossinessTexture")};
inline constexpr std::array kAnisotropy{number("anisotropyStrength"), number("anisotropyRotation"),
                                        texture("anisotropyTexture")};
inline constexpr std::array kClearcoat{
    number("clearcoatFactor"), texture("clearcoatTexture"), number("clearcoatRoughnessFactor"),
    texture("clearcoatRoughnessTexture"), texture("clearcoatNormalTexture")};
inline constexpr std::array kDiffuseTransmission{
    number("diffuseTransmissionFactor"), texture("diffuseTransmissionTexture"),
    numbers("diffuseTransmissionColorFactor", 3), texture("diffuseTransmissionColorTexture")};
inline constexpr std::array kDispersion{number("dispersion")};
inline constexpr std::array kEmissiveStrength{number("emissiveStrength")};
inline constexpr std::array kIor{number("ior")};
inline constexpr std::array kIridescence{number("iridescenceFactor"),
                                         texture("iridescenceTexture"),
                                         number("iridescenceIor"),
                                         number("iridescenceThicknessMinimum"),
                                         number("iridescenceThicknessMaximum"),
                                         texture("iridescenceThicknessTexture")};
inline constexpr std::array kSheen{numbers("sheenColorFactor", 3), texture("sheenColorTexture"),
                                   number("sheenRoughnessFactor"), texture("sheenRoughnessTexture")};
inline constexpr std::array kSpecular{number("specularFactor"), texture("specularTexture"),
                                      numbers("specularColorFactor", 3), texture("specularColorTexture")};
inline constexpr std::array kTransmission{number("transmissionFactor"), texture("transmissionTexture")};
inline constexpr std::array kVolume{number("thicknessFactor"), texture("thicknessTexture"),
                                    distance("attenuationDistance"), numbers("attenuationColor", 3)};

inline constexpr std::array kMaterialExtensions{
    object("KHR_materials_anisotropy", kAnisotropy),
    object("KHR_materials_clearcoat", kClearcoat),
    object("KHR_materials_diffuse_transmission", kDiffuseTransmission),
    object("KHR_materials_dispersion", kDispersion),
    object("KHR_materials_emissive_strength", kEmissiveStrength),
    object("KHR_materials_ior", kIor),
    object("KHR_materials_iridescence", kIridescence),
    object("KHR_materials_pbrSpecularGlossiness", kSpecularGlossiness),
    object("KHR_materials_sheen", kSheen),
    object("KHR_materials_specular", kSpecular),
    object("KHR_materials_transmission", kTransmission),
    object("KHR_materials_unlit", {}),
    object("KHR_materials_volume", kVolume)};

inline constexpr std::array kMaterial{text("name"),
                                      object("pbrMetallicRoughness", kMetallicRoughness),
                                      texture("normalTexture"),
                                      texture("occlusionTexture"),
                                      texture("emissiveTexture"),
                                      numbers("emissiveFactor", 3),
                                      text("alphaMode"),
                                      number("alphaCutoff"),
                                      boolean("doubleSided"),
                                      object("extensions", kMaterialExtensions)};

}  // namespace glint::gltf::rules

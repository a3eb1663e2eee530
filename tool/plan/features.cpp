#include "plan/features.h"

#include "plan/rules.h"

#include <fmt/format.h>

#include <algorithm>

namespace glint {

namespace {

// Lobes come first, because their textures depend on them. Textures come before the texture coordinates and
// tangents that they need.
constexpr FeatureInfo kTable[] = {
    {Feature::Unlit, "unlit", "Unlit", "GLINT_UNLIT", "materials[].extensions.KHR_materials_unlit",
     "never: its presence changes the shading", rules::unlit},
    {Feature::SpecularGlossiness, "specularGlossiness", "SpecGloss", "GLINT_SPECULAR_GLOSSINESS",
     "materials[].extensions.KHR_materials_pbrSpecularGlossiness",
     "unlit; else never: it is another base model", rules::specularGlossiness},
    {Feature::Ior, "ior", "Ior", "GLINT_IOR", "materials[].extensions.KHR_materials_ior",
     "ior is 1.5, or metallicFactor is 1", rules::ior},
    {Feature::Specular, "specular", "Specular", "GLINT_SPECULAR",
     "materials[].extensions.KHR_materials_specular",
     "specularFactor is 1 and specularColorFactor white, or metallicFactor is 1", rules::specular},
    {Feature::Clearcoat, "clearcoat", "Clearcoat", "GLINT_CLEARCOAT",
     "materials[].extensions.KHR_materials_clearcoat", "clearcoatFactor is 0", rules::clearcoat},
    {Feature::Sheen, "sheen", "Sheen", "GLINT_SHEEN", "materials[].extensions.KHR_materials_sheen",
     "sheenColorFactor is black", rules::sheen},
    {Feature::Anisotropy, "anisotropy", "Anisotropy", "GLINT_ANISOTROPY",
     "materials[].extensions.KHR_materials_anisotropy",
     "anisotropyStrength is 0, or roughnessFactor is 1, or nothing gives a direction", rules::anisotropy},
    {Feature::Iridescence, "iridescence", "Iridescence", "GLINT_IRIDESCENCE",
     "materials[].extensions.KHR_materials_iridescence",
     "iridescenceFactor is 0, or the film has no thickness, or iridescenceIor is 1", rules::iridescence},
    {Feature::Transmission, "transmission", "Transmission", "GLINT_TRANSMISSION",
     "materials[].extensions.KHR_materials_transmission", "transmissionFactor is 0, or metallicFactor is 1",
     rules::transmission},
    {Feature::DiffuseTransmission, "diffuseTransmission", "DiffuseTransmission", "GLINT_DIFFUSE_TRANSMISSION",
     "materials[].extensions.KHR_materials_diffuse_transmission",
     "diffuseTransmissionFactor is 0, or metallicFactor is 1, or transmissionFactor is 1",
     rules::diffuseTransmission},
    {Feature::Volume, "volume", "Volume", "GLINT_VOLUME", "materials[].extensions.KHR_materials_volume",
     "thicknessFactor is 0, or nothing transmits light", rules::volume},
    {Feature::Attenuation, "attenuation", "Attenuation", "GLINT_ATTENUATION",
     "materials[].extensions.KHR_materials_volume.attenuationColor",
     "attenuationColor is white, or attenuationDistance infinite, or there is no volume", rules::attenuation},
    {Feature::Dispersion, "dispersion", "Dispersion", "GLINT_DISPERSION",
     "materials[].extensions.KHR_materials_dispersion",
     "dispersion is 0, or ior is 1, or there is no volume or no transmission", rules::dispersion},
    {Feature::PartialMetal, "partialMetal", "PartMetal", "GLINT_PARTIAL_METAL",
     "materials[].pbrMetallicRoughness.metallicFactor",
     "metallicFactor is 0, or it is 1 and no metallicRoughnessTexture is read", rules::partialMetal},
    {Feature::BaseColorTexture, "baseColorTexture", "BaseTex", "GLINT_BASE_COLOR_TEXTURE",
     "materials[].pbrMetallicRoughness.baseColorTexture", "baseColorFactor is black",
     rules::baseColorTexture},
    {Feature::MetallicRoughnessTexture, "metallicRoughnessTexture", "MetalRoughTex",
     "GLINT_METALLIC_ROUGHNESS_TEXTURE", "materials[].pbrMetallicRoughness.metallicRoughnessTexture",
     "metallicFactor and roughnessFactor are 0", rules::metallicRoughnessTexture},
    {Feature::NormalTexture, "normalTexture", "NormalTex", "GLINT_NORMAL_TEXTURE",
     "materials[].normalTexture", "scale is 0", rules::normalTexture},
    {Feature::OcclusionTexture, "occlusionTexture", "OcclusionTex", "GLINT_OCCLUSION_TEXTURE",
     "materials[].occlusionTexture", "strength is 0", rules::occlusionTexture},
    {Feature::EmissiveTexture, "emissiveTexture", "EmissiveTex", "GLINT_EMISSIVE_TEXTURE",
     "materials[].emissiveTexture", "emissiveFactor times emissiveStrength is 0", rules::emissiveTexture},
    {Feature::ClearcoatTexture, "clearcoatTexture", "ClearcoatTex", "GLINT_CLEARCOAT_TEXTURE",
     "materials[].extensions.KHR_materials_clearcoat.clearcoatTexture", "there is no clearcoat",
     rules::textureOf<TextureSlot::Clearcoat, Feature::Clearcoat>},
    {Feature::ClearcoatRoughnessTexture, "clearcoatRoughnessTexture", "ClearcoatRoughTex",
     "GLINT_CLEARCOAT_ROUGHNESS_TEXTURE",
     "materials[].extensions.KHR_materials_clearcoat.clearcoatRoughnessTexture",
     "clearcoatRoughnessFactor is 0", rules::textureOf<TextureSlot::ClearcoatRoughness, Feature::Clearcoat>},
    {Feature::ClearcoatSharesNormal, "clearcoatSharesNormal", "ClearcoatSharesNormal",
     "GLINT_CLEARCOAT_SHARES_NORMAL", "materials[].extensions.KHR_materials_clearcoat.clearcoatNormalTexture",
     "it is another texture than normalTexture", rules::clearcoatSharesNormal},
    {Feature::ClearcoatNormalTexture, "clearcoatNormalTexture", "ClearcoatNormalTex",
     "GLINT_CLEARCOAT_NORMAL_TEXTURE",
     "materials[].extensions.KHR_materials_clearcoat.clearcoatNormalTexture",
     "scale is 0, or it is normalTexture", rules::clearcoatNormalTexture},
    {Feature::SheenColorTexture, "sheenColorTexture", "SheenColorTex", "GLINT_SHEEN_COLOR_TEXTURE",
     "materials[].extensions.KHR_materials_sheen.sheenColorTexture", "there is no sheen",
     rules::textureOf<TextureSlot::SheenColor, Feature::Sheen>},
    {Feature::SheenRoughnessTexture, "sheenRoughnessTexture", "SheenRoughTex",
     "GLINT_SHEEN_ROUGHNESS_TEXTURE", "materials[].extensions.KHR_materials_sheen.sheenRoughnessTexture",
     "sheenRoughnessFactor is 0", rules::textureOf<TextureSlot::SheenRoughness, Feature::Sheen>},
    {Feature::AnisotropyTexture, "anisotropyTexture", "AnisotropyTex", "GLINT_ANISOTROPY_TEXTURE",
     "materials[].extensions.KHR_materials_anisotropy.anisotropyTexture", "there is no anisotropy",
     rules::textureOf<TextureSlot::Anisotropy, Feature::Anisotropy>},
    {Feature::SpecularTexture, "specularTexture", "SpecularTex", "GLINT_SPECULAR_TEXTURE",
     "materials[].extensions.KHR_materials_specular.specularTexture", "specularFactor is 0",
     rules::textureOf<TextureSlot::Specular, Feature::Specular>},
    {Feature::SpecularColorTexture, "specularColorTexture", "SpecularColorTex",
     "GLINT_SPECULAR_COLOR_TEXTURE", "materials[].extensions.KHR_materials_specular.specularColorTexture",
     "specularFactor is 0, or specularColorFactor is black",
     rules::textureOf<TextureSlot::SpecularColor, Feature::Specular>},
    {Feature::IridescenceTexture, "iridescenceTexture", "IridescenceTex", "GLINT_IRIDESCENCE_TEXTURE",
     "materials[].extensions.KHR_materials_iridescence.iridescenceTexture", "there is no iridescence",
     rules::textureOf<TextureSlot::Iridescence, Feature::Iridescence>},
    {Feature::IridescenceThicknessTexture, "iridescenceThicknessTexture", "FilmThicknessTex",
     "GLINT_IRIDESCENCE_THICKNESS_TEXTURE",
     "materials[].extensions.KHR_materials_iridescence.iridescenceThicknessTexture",
     "iridescenceThicknessMinimum and Maximum are the same",
     rules::textureOf<TextureSlot::IridescenceThickness, Feature::Iridescence>},
    {Feature::TransmissionTexture, "transmissionTexture", "TransmissionTex", "GLINT_TRANSMISSION_TEXTURE",
     "materials[].extensions.KHR_materials_transmission.transmissionTexture", "there is no transmission",
     rules::textureOf<TextureSlot::Transmission, Feature::Transmission>},
    {Feature::ThicknessTexture, "thicknessTexture", "ThicknessTex", "GLINT_THICKNESS_TEXTURE",
     "materials[].extensions.KHR_materials_volume.thicknessTexture",
     "there is no attenuation, which alone reads it",
     rules::textureOf<TextureSlot::Thickness, Feature::Attenuation>},
    {Feature::DiffuseTransmissionTexture, "diffuseTransmissionTexture", "DiffuseTransmissionTex",
     "GLINT_DIFFUSE_TRANSMISSION_TEXTURE",
     "materials[].extensions.KHR_materials_diffuse_transmission.diffuseTransmissionTexture",
     "there is no diffuseTransmission",
     rules::textureOf<TextureSlot::DiffuseTransmission, Feature::DiffuseTransmission>},
    {Feature::DiffuseTransmissionColorTexture, "diffuseTransmissionColorTexture",
     "DiffuseTransmissionColorTex", "GLINT_DIFFUSE_TRANSMISSION_COLOR_TEXTURE",
     "materials[].extensions.KHR_materials_diffuse_transmission.diffuseTransmissionColorTexture",
     "diffuseTransmissionColorFactor is black",
     rules::textureOf<TextureSlot::DiffuseTransmissionColor, Feature::DiffuseTransmission>},
    {Feature::EmissiveStrength, "emissiveStrength", "EmissiveStrength", "GLINT_EMISSIVE_STRENGTH",
     "materials[].extensions.KHR_materials_emissive_strength",
     "emissiveStrength is 1, or emissiveFactor is black", rules::emissiveStrength},
    {Feature::TexCoord0, "texCoord0", "Uv0", "GLINT_TEXCOORD_0", "textureInfo.texCoord = 0",
     "no texture that is read uses the set", rules::texCoord<0>},
    {Feature::TexCoord1, "texCoord1", "Uv1", "GLINT_TEXCOORD_1", "textureInfo.texCoord = 1",
     "no texture that is read uses the set", rules::texCoord<1>},
    {Feature::TextureTransform, "textureTransform", "Transform", "GLINT_TEXTURE_TRANSFORM",
     "textureInfo.extensions.KHR_texture_transform", "identity on every texture that is read",
     rules::textureTransform},
    {Feature::VertexColor, "vertexColor", "Color", "GLINT_VERTEX_COLOR",
     "meshes[].primitives[].attributes.COLOR_0", "white everywhere, or baseColorFactor is black",
     rules::vertexColor},
    {Feature::Normals, "normals", "Normals", "GLINT_NORMALS", "meshes[].primitives[].attributes.NORMAL",
     "unlit", rules::normals},
    {Feature::Tangents, "tangents", "Tangents", "GLINT_TANGENTS", "meshes[].primitives[].attributes.TANGENT",
     "neither a normal texture nor anisotropy is read", rules::tangents},
    {Feature::DoubleSided, "doubleSided", "DoubleSided", "GLINT_DOUBLE_SIDED", "materials[].doubleSided",
     "unlit", rules::doubleSided},
    {Feature::AlphaMask, "alphaMask", "Mask", "GLINT_ALPHA_MASK", "materials[].alphaMode = MASK",
     "alpha is never below alphaCutoff, or hits are forced opaque", rules::alphaMask},
};

}  // namespace

std::span<const FeatureInfo> featureTable() {
    return kTable;
}

std::vector<std::string_view> featureNames(FeatureMask mask) {
    std::vector<const FeatureInfo*> rows;
    for (const FeatureInfo& info : kTable) {
        if ((mask & bit(info.feature)) != 0) {
            rows.push_back(&info);
        }
    }
    std::ranges::sort(rows, {}, [](const FeatureInfo* info) { return info->feature; });
    std::vector<std::string_view> names;
    names.reserve(rows.size());
    for (const FeatureInfo* info : rows) {
        names.push_back(info->name);
    }
    return names;
}

std::string featureDefines() {
    std::string text;
    for (const FeatureInfo& info : kTable) {
        const unsigned bitInWord = static_cast<unsigned>(info.feature) % 32U;
        text += fmt::format("#define {} 0x{:x}u\n", info.macro, 1U << bitInWord);
    }
    return text;
}

}  // namespace glint

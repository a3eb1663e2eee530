#include "plan/features.h"

#include <fmt/format.h>

#include <algorithm>

namespace glint {

namespace {

constexpr const char* kUnlitReadsBaseColor = "unlit shading reads the base colour alone";

bool has(FeatureMask mask, Feature feature) {
    return (mask & bit(feature)) != 0;
}

Presence absent() {
    return {};
}

Presence present() {
    return {true, {}};
}

Presence dropped(std::string reason) {
    return {false, std::move(reason)};
}

bool isIdentity(const TextureTransform& transform) {
    return transform.offset[0] == 0.0F && transform.offset[1] == 0.0F && transform.rotation == 0.0F &&
           transform.scale[0] == 1.0F && transform.scale[1] == 1.0F;
}

bool isBlack(const Material& material) {
    return material.baseColorFactor[0] == 0.0F && material.baseColorFactor[1] == 0.0F &&
           material.baseColorFactor[2] == 0.0F;
}

bool emits(const Material& material) {
    return material.emissiveStrength != 0.0F &&
           (material.emissiveFactor[0] != 0.0F || material.emissiveFactor[1] != 0.0F ||
            material.emissiveFactor[2] != 0.0F);
}

bool hasTexCoords(const PrimitiveInputs& primitive, int set) {
    return set == 0 ? primitive.hasTexCoords0 : set == 1 && primitive.hasTexCoords1;
}

// Whether a slot can be read at all; `neutral` is the reason why reading it changes nothing, or null.
Presence textureRule(const Material& material, const PrimitiveInputs& primitive, TextureSlot slot,
                     const char* neutral) {
    const TextureInfo& info = material.texture(slot);
    if (info.texture < 0) {
        return absent();
    }
    if (neutral != nullptr) {
        return dropped(neutral);
    }
    if (info.texCoord > 1) {
        return dropped(fmt::format("it reads TEXCOORD_{}; Glint reads sets 0 and 1", info.texCoord));
    }
    if (!hasTexCoords(primitive, info.texCoord)) {
        return dropped(fmt::format("the primitive has no TEXCOORD_{}", info.texCoord));
    }
    return present();
}

// Whether alpha can fall below the cut-off: whether testing it can change anything.
bool canFailAlphaTest(const Material& material, const PrimitiveInputs& primitive) {
    if (material.alphaCutoff <= 0.0F) {
        return false;
    }
    const TextureInfo& info = material.texture(TextureSlot::BaseColor);
    const bool textured = info.texture >= 0 && hasTexCoords(primitive, info.texCoord);
    return textured || primitive.colors == ColorContent::Varying ||
           material.baseColorFactor[3] < material.alphaCutoff;
}

bool isAlphaTested(const Material& material, const PrimitiveInputs& primitive, const KeyOptions& options) {
    return options.alpha == AlphaPolicy::Tested && material.alphaMode == AlphaMode::Mask &&
           canFailAlphaTest(material, primitive);
}

// The slots whose textures a key reads.
constexpr struct {
    Feature feature;
    TextureSlot slot;
} kTextureFeatures[] = {
    {Feature::BaseColorTexture, TextureSlot::BaseColor},
    {Feature::MetallicRoughnessTexture, TextureSlot::MetallicRoughness},
    {Feature::NormalTexture, TextureSlot::Normal},
    {Feature::OcclusionTexture, TextureSlot::Occlusion},
    {Feature::EmissiveTexture, TextureSlot::Emissive},
};

Presence unlitRule(const Material& material, const PrimitiveInputs&, const KeyOptions&, FeatureMask) {
    return material.unlit ? present() : absent();
}

Presence baseColorTextureRule(const Material& material, const PrimitiveInputs& primitive,
                              const KeyOptions& options, FeatureMask) {
    const bool black = isBlack(material) && !isAlphaTested(material, primitive, options);
    return textureRule(material, primitive, TextureSlot::BaseColor,
                       black ? "baseColorFactor is black" : nullptr);
}

Presence metallicRoughnessTextureRule(const Material& material, const PrimitiveInputs& primitive,
                                      const KeyOptions&, FeatureMask soFar) {
    const bool zero = material.metallicFactor == 0.0F && material.roughnessFactor == 0.0F;
    const char* neutral = has(soFar, Feature::Unlit) ? kUnlitReadsBaseColor
                          : zero                     ? "metallicFactor and roughnessFactor are 0"
                                                     : nullptr;
    return textureRule(material, primitive, TextureSlot::MetallicRoughness, neutral);
}

Presence normalTextureRule(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
                           FeatureMask soFar) {
    const char* neutral = has(soFar, Feature::Unlit)     ? kUnlitReadsBaseColor
                          : material.normalScale == 0.0F ? "its scale is 0"
                                                         : nullptr;
    return textureRule(material, primitive, TextureSlot::Normal, neutral);
}

Presence occlusionTextureRule(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
                              FeatureMask soFar) {
    const char* neutral = has(soFar, Feature::Unlit)           ? kUnlitReadsBaseColor
                          : material.occlusionStrength == 0.0F ? "its strength is 0"
                                                               : nullptr;
    return textureRule(material, primitive, TextureSlot::Occlusion, neutral);
}

Presence emissiveTextureRule(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
                             FeatureMask soFar) {
    const char* neutral = has(soFar, Feature::Unlit) ? kUnlitReadsBaseColor
                          : !emits(material)         ? "emissiveFactor times emissiveStrength is 0"
                                                     : nullptr;
    return textureRule(material, primitive, TextureSlot::Emissive, neutral);
}

Presence emissiveStrengthRule(const Material& material, const PrimitiveInputs&, const KeyOptions&,
                              FeatureMask soFar) {
    if (!material.hasEmissiveStrength && material.emissiveStrength == 1.0F) {
        return absent();
    }
    if (has(soFar, Feature::Unlit)) {
        return dropped(kUnlitReadsBaseColor);
    }
    if (material.emissiveStrength == 1.0F) {
        return dropped("emissiveStrength is 1");
    }
    // A strength of 0 is not neutral unless nothing was emitted in the first place.
    const auto& factor = material.emissiveFactor;
    return factor[0] == 0.0F && factor[1] == 0.0F && factor[2] == 0.0F ? dropped("emissiveFactor is black")
                                                                       : present();
}

template <int kSet>
Presence texCoordRule(const Material& material, const PrimitiveInputs&, const KeyOptions&,
                      FeatureMask soFar) {
    const bool used = std::ranges::any_of(kTextureFeatures, [&](const auto& entry) {
        return has(soFar, entry.feature) && material.texture(entry.slot).texCoord == kSet;
    });
    return used ? present() : absent();
}

Presence textureTransformRule(const Material& material, const PrimitiveInputs&, const KeyOptions&,
                              FeatureMask soFar) {
    bool given = false;
    for (const auto& entry : kTextureFeatures) {
        const TextureInfo& info = material.texture(entry.slot);
        const bool moves = !isIdentity(info.transform);
        if (has(soFar, entry.feature) && moves) {
            return present();
        }
        given = given || info.hasTransform || moves;
    }
    return given ? dropped("every texture that is read has the identity transform") : absent();
}

Presence vertexColorRule(const Material& material, const PrimitiveInputs& primitive,
                         const KeyOptions& options, FeatureMask) {
    if (primitive.colors == ColorContent::None) {
        return absent();
    }
    if (primitive.colors == ColorContent::White) {
        return dropped("COLOR_0 is white everywhere");
    }
    if (isBlack(material) && !isAlphaTested(material, primitive, options)) {
        return dropped("baseColorFactor is black");
    }
    return present();
}

Presence normalsRule(const Material&, const PrimitiveInputs& primitive, const KeyOptions&,
                     FeatureMask soFar) {
    if (!primitive.hasNormals) {
        return absent();
    }
    return has(soFar, Feature::Unlit) ? dropped(kUnlitReadsBaseColor) : present();
}

Presence tangentsRule(const Material&, const PrimitiveInputs& primitive, const KeyOptions&,
                      FeatureMask soFar) {
    if (!primitive.hasTangents) {
        return absent();
    }
    if (!has(soFar, Feature::NormalTexture)) {
        return dropped("no normal texture reads them");
    }
    return has(soFar, Feature::Normals) ? present() : dropped("the primitive has no NORMAL");
}

Presence doubleSidedRule(const Material& material, const PrimitiveInputs&, const KeyOptions&,
                         FeatureMask soFar) {
    if (!material.doubleSided) {
        return absent();
    }
    return has(soFar, Feature::Unlit) ? dropped(kUnlitReadsBaseColor) : present();
}

Presence alphaMaskRule(const Material& material, const PrimitiveInputs& primitive, const KeyOptions& options,
                       FeatureMask) {
    switch (material.alphaMode) {
        case AlphaMode::Opaque:
            return absent();
        case AlphaMode::Blend:
            return dropped("alphaMode BLEND is drawn opaque: rays see no blending order");
        case AlphaMode::Mask:
            break;
    }
    if (options.alpha == AlphaPolicy::Opaque) {
        return dropped("hits are forced opaque (--alpha opaque)");
    }
    return canFailAlphaTest(material, primitive) ? present() : dropped("alpha is never below alphaCutoff");
}

constexpr FeatureInfo kTable[] = {
    {Feature::Unlit, "unlit", "Unlit", "GLINT_UNLIT", "materials[].extensions.KHR_materials_unlit",
     "never: its presence changes the shading", unlitRule},
    {Feature::BaseColorTexture, "baseColorTexture", "BaseTex", "GLINT_BASE_COLOR_TEXTURE",
     "materials[].pbrMetallicRoughness.baseColorTexture", "baseColorFactor is black", baseColorTextureRule},
    {Feature::MetallicRoughnessTexture, "metallicRoughnessTexture", "MetalRoughTex",
     "GLINT_METALLIC_ROUGHNESS_TEXTURE", "materials[].pbrMetallicRoughness.metallicRoughnessTexture",
     "metallicFactor and roughnessFactor are 0", metallicRoughnessTextureRule},
    {Feature::NormalTexture, "normalTexture", "NormalTex", "GLINT_NORMAL_TEXTURE",
     "materials[].normalTexture", "scale is 0", normalTextureRule},
    {Feature::OcclusionTexture, "occlusionTexture", "OcclusionTex", "GLINT_OCCLUSION_TEXTURE",
     "materials[].occlusionTexture", "strength is 0", occlusionTextureRule},
    {Feature::EmissiveTexture, "emissiveTexture", "EmissiveTex", "GLINT_EMISSIVE_TEXTURE",
     "materials[].emissiveTexture", "emissiveFactor times emissiveStrength is 0", emissiveTextureRule},
    {Feature::EmissiveStrength, "emissiveStrength", "EmissiveStrength", "GLINT_EMISSIVE_STRENGTH",
     "materials[].extensions.KHR_materials_emissive_strength",
     "emissiveStrength is 1, or emissiveFactor is black", emissiveStrengthRule},
    {Feature::TexCoord0, "texCoord0", "Uv0", "GLINT_TEXCOORD_0", "textureInfo.texCoord = 0",
     "no texture that is read uses the set", texCoordRule<0>},
    {Feature::TexCoord1, "texCoord1", "Uv1", "GLINT_TEXCOORD_1", "textureInfo.texCoord = 1",
     "no texture that is read uses the set", texCoordRule<1>},
    {Feature::TextureTransform, "textureTransform", "Transform", "GLINT_TEXTURE_TRANSFORM",
     "textureInfo.extensions.KHR_texture_transform", "identity on every texture that is read",
     textureTransformRule},
    {Feature::VertexColor, "vertexColor", "Color", "GLINT_VERTEX_COLOR",
     "meshes[].primitives[].attributes.COLOR_0", "white everywhere, or baseColorFactor is black",
     vertexColorRule},
    {Feature::Normals, "normals", "Normals", "GLINT_NORMALS", "meshes[].primitives[].attributes.NORMAL",
     "unlit", normalsRule},
    {Feature::Tangents, "tangents", "Tangents", "GLINT_TANGENTS", "meshes[].primitives[].attributes.TANGENT",
     "no normal texture is read", tangentsRule},
    {Feature::DoubleSided, "doubleSided", "DoubleSided", "GLINT_DOUBLE_SIDED", "materials[].doubleSided",
     "unlit", doubleSidedRule},
    {Feature::AlphaMask, "alphaMask", "Mask", "GLINT_ALPHA_MASK", "materials[].alphaMode = MASK",
     "alpha is never below alphaCutoff, or hits are forced opaque", alphaMaskRule},
};

}  // namespace

std::span<const FeatureInfo> featureTable() {
    return kTable;
}

std::vector<std::string_view> featureNames(FeatureMask mask) {
    std::vector<const FeatureInfo*> rows;
    for (const FeatureInfo& info : kTable) {
        if (has(mask, info.feature)) {
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

#include "plan/rules.h"

#include <fmt/format.h>

#include <algorithm>

namespace glint::rules {

namespace {

// The slots and the features of the textures that a key reads.
constexpr struct {
    Feature feature;
    TextureSlot slot;
} kTextureFeatures[] = {
    {Feature::BaseColorTexture, TextureSlot::BaseColor},
    {Feature::MetallicRoughnessTexture, TextureSlot::MetallicRoughness},
    {Feature::NormalTexture, TextureSlot::Normal},
    {Feature::OcclusionTexture, TextureSlot::Occlusion},
    {Feature::EmissiveTexture, TextureSlot::Emissive},
    {Feature::ClearcoatTexture, TextureSlot::Clearcoat},
    {Feature::ClearcoatRoughnessTexture, TextureSlot::ClearcoatRoughness},
    {Feature::ClearcoatNormalTexture, TextureSlot::ClearcoatNormal},
    {Feature::SheenColorTexture, TextureSlot::SheenColor},
    {Feature::SheenRoughnessTexture, TextureSlot::SheenRoughness},
    {Feature::AnisotropyTexture, TextureSlot::Anisotropy},
    {Feature::SpecularTexture, TextureSlot::Specular},
    {Feature::SpecularColorTexture, TextureSlot::SpecularColor},
    {Feature::IridescenceTexture, TextureSlot::Iridescence},
    {Feature::IridescenceThicknessTexture, TextureSlot::IridescenceThickness},
    {Feature::TransmissionTexture, TextureSlot::Transmission},
    {Feature::ThicknessTexture, TextureSlot::Thickness},
    {Feature::DiffuseTransmissionTexture, TextureSlot::DiffuseTransmission},
    {Feature::DiffuseTransmissionColorTexture, TextureSlot::DiffuseTransmissionColor},
};

bool isIdentity(const TextureTransform& transform) {
    return transform.offset[0] == 0.0F && transform.offset[1] == 0.0F && transform.rotation == 0.0F &&
           transform.scale[0] == 1.0F && transform.scale[1] == 1.0F;
}

bool isZero(const std::array<float, 3>& color) {
    return std::ranges::all_of(color, [](float channel) { return channel == 0.0F; });
}

bool hasTexCoords(const PrimitiveInputs& primitive, int set) {
    return set == 0 ? primitive.hasTexCoords0 : set == 1 && primitive.hasTexCoords1;
}

// Decides whether a slot is read. `neutral` is the reason why reading it changes nothing, or empty.
Presence textureRule(const Material& material, const PrimitiveInputs& primitive, TextureSlot slot,
                     std::string neutral) {
    const TextureInfo& info = material.texture(slot);
    if (info.texture < 0) {
        return absent();
    }
    if (!neutral.empty()) {
        return dropped(std::move(neutral));
    }
    if (info.texCoord > 1) {
        return dropped(fmt::format("it reads TEXCOORD_{}; Glint reads sets 0 and 1", info.texCoord));
    }
    if (!hasTexCoords(primitive, info.texCoord)) {
        return dropped(fmt::format("the primitive has no TEXCOORD_{}", info.texCoord));
    }
    return present();
}

// Returns the reason for a lit key: `neutral` if `holds`. An unlit key has its own reason.
const char* reasonIf(FeatureMask soFar, bool holds, const char* neutral) {
    return has(soFar, Feature::Unlit) ? kUnlitReadsBaseColor : holds ? neutral : "";
}

// Returns why a present lobe does not need the slot's texture because other values cancel it, or an empty
// text.
const char* cancelled(const Material& material, TextureSlot slot) {
    const auto reasonWhere = [](bool holds, const char* reason) { return holds ? reason : ""; };
    switch (slot) {
        case TextureSlot::ClearcoatRoughness:
            return reasonWhere(material.clearcoat.roughnessFactor == 0.0F, "clearcoatRoughnessFactor is 0");
        case TextureSlot::ClearcoatNormal:
            return reasonWhere(material.clearcoat.normalScale == 0.0F, "its scale is 0");
        case TextureSlot::SheenRoughness:
            return reasonWhere(material.sheen.roughnessFactor == 0.0F, "sheenRoughnessFactor is 0");
        case TextureSlot::Specular:
            return reasonWhere(material.specular.factor == 0.0F, "specularFactor is 0");
        case TextureSlot::SpecularColor:
            // At grazing angles specularFactor alone counts, so a black colour does not cancel the lobe.
            return material.specular.factor == 0.0F
                       ? "specularFactor is 0"
                       : reasonWhere(isZero(material.specular.colorFactor), "specularColorFactor is black");
        case TextureSlot::IridescenceThickness:
            return reasonWhere(material.iridescence.thicknessMinimum == material.iridescence.thicknessMaximum,
                               "the film's least and largest thickness are the same");
        case TextureSlot::DiffuseTransmissionColor:
            return reasonWhere(isZero(material.diffuseTransmission.colorFactor),
                               "diffuseTransmissionColorFactor is black");
        default:
            return "";
    }
}

std::string_view nameOf(Feature feature) {
    return std::ranges::find(featureTable(), feature, &FeatureInfo::feature)->name;
}

bool sameTexture(const TextureInfo& a, const TextureInfo& b) {
    return a.texture == b.texture && a.texCoord == b.texCoord && a.transform.offset == b.transform.offset &&
           a.transform.rotation == b.transform.rotation && a.transform.scale == b.transform.scale;
}

}  // namespace

bool isReadable(const Material& material, const PrimitiveInputs& primitive, TextureSlot slot) {
    const TextureInfo& info = material.texture(slot);
    return info.texture >= 0 && hasTexCoords(primitive, info.texCoord);
}

bool isBlack(const Material& material) {
    const auto& color = material.baseColorFactor;
    return color[0] == 0.0F && color[1] == 0.0F && color[2] == 0.0F;
}

Presence baseColorTexture(const Material& material, const PrimitiveInputs& primitive,
                          const KeyOptions& options, FeatureMask) {
    const bool black = isBlack(material) && !isAlphaTested(material, primitive, options);
    return textureRule(material, primitive, TextureSlot::BaseColor, black ? "baseColorFactor is black" : "");
}

Presence metallicRoughnessTexture(const Material& material, const PrimitiveInputs& primitive,
                                  const KeyOptions&, FeatureMask soFar) {
    // In this model the slot's texture holds specular colour and glossiness.
    if (has(soFar, Feature::SpecularGlossiness)) {
        const bool zero = isZero(material.specularGlossiness.specularFactor) &&
                          material.specularGlossiness.glossinessFactor == 0.0F;
        return textureRule(material, primitive, TextureSlot::MetallicRoughness,
                           zero ? "specularFactor is black and glossinessFactor is 0" : "");
    }
    const bool zero = material.metallicFactor == 0.0F && material.roughnessFactor == 0.0F;
    return textureRule(material, primitive, TextureSlot::MetallicRoughness,
                       reasonIf(soFar, zero, "metallicFactor and roughnessFactor are 0"));
}

Presence normalTexture(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
                       FeatureMask soFar) {
    return textureRule(material, primitive, TextureSlot::Normal,
                       reasonIf(soFar, material.normalScale == 0.0F, "its scale is 0"));
}

Presence occlusionTexture(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
                          FeatureMask soFar) {
    return textureRule(material, primitive, TextureSlot::Occlusion,
                       reasonIf(soFar, material.occlusionStrength == 0.0F, "its strength is 0"));
}

Presence emissiveTexture(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
                         FeatureMask soFar) {
    const bool dark = material.emissiveStrength == 0.0F || isZero(material.emissiveFactor);
    return textureRule(material, primitive, TextureSlot::Emissive,
                       reasonIf(soFar, dark, "emissiveFactor times emissiveStrength is 0"));
}

Presence lobeTexture(const Material& material, const PrimitiveInputs& primitive, FeatureMask soFar,
                     TextureSlot slot, Feature lobe) {
    if (has(soFar, lobe)) {
        return textureRule(material, primitive, slot, cancelled(material, slot));
    }
    return textureRule(material, primitive, slot, fmt::format("the key has no {}", nameOf(lobe)));
}

Presence clearcoatSharesNormal(const Material& material, const PrimitiveInputs&, const KeyOptions&,
                               FeatureMask soFar) {
    const bool shares =
        has(soFar, Feature::Clearcoat) && has(soFar, Feature::NormalTexture) &&
        material.clearcoat.normalScale == material.normalScale &&
        sameTexture(material.texture(TextureSlot::ClearcoatNormal), material.texture(TextureSlot::Normal));
    return shares ? present() : absent();
}

Presence clearcoatNormalTexture(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
                                FeatureMask soFar) {
    if (has(soFar, Feature::ClearcoatSharesNormal)) {
        return dropped("it is normalTexture, which is read once for both (clearcoatSharesNormal)");
    }
    return lobeTexture(material, primitive, soFar, TextureSlot::ClearcoatNormal, Feature::Clearcoat);
}

bool readsTexCoord(const Material& material, const PrimitiveInputs& primitive, FeatureMask soFar, int set) {
    const bool read = std::ranges::any_of(kTextureFeatures, [&](const auto& entry) {
        return has(soFar, entry.feature) && material.texture(entry.slot).texCoord == set;
    });
    if (read) {
        return true;
    }
    // If the primitive has no tangents, the direction of anisotropy comes from texture coordinates: those of
    // a texture that is read, or else the first set that exists.
    const bool derives = has(soFar, Feature::Anisotropy) && !has(soFar, Feature::NormalTexture) &&
                         !has(soFar, Feature::AnisotropyTexture) &&
                         !(primitive.hasTangents && primitive.hasNormals);
    return derives && set == (primitive.hasTexCoords0 ? 0 : 1);
}

Presence textureTransform(const Material& material, const PrimitiveInputs&, const KeyOptions&,
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

}  // namespace glint::rules

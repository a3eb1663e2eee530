#include "plan/rules.h"

#include <algorithm>
#include <initializer_list>

namespace glint::rules {

namespace {

constexpr const char* kFullyMetallic = "metallicFactor is 1, and it acts on the dielectric part alone";

bool isAll(const std::array<float, 3>& color, float value) {
    return std::ranges::all_of(color, [value](float channel) { return channel == value; });
}

// A lobe stays unless a reason to drop it holds: `none`, or else the first of `reasons` that holds. If the
// file does not ask for the lobe, dropping it is not reported.
struct Reason {
    bool holds;
    const char* text;
};

Presence lobe(bool given, FeatureMask soFar, std::initializer_list<Reason> reasons) {
    const char* found = has(soFar, Feature::Unlit) ? kUnlitReadsBaseColor
                        : has(soFar, Feature::SpecularGlossiness)
                            ? "KHR_materials_pbrSpecularGlossiness excludes it"
                            : nullptr;
    bool neutral = false;
    for (const Reason& reason : reasons) {
        if (reason.holds) {
            found = found == nullptr ? reason.text : found;
            neutral = true;
        }
    }
    if (found == nullptr) {
        return present();
    }
    return given || !neutral ? dropped(found) : absent();
}

bool isFullyRough(const Material& material, const PrimitiveInputs& primitive) {
    return material.roughnessFactor == 1.0F &&
           !isReadable(material, primitive, TextureSlot::MetallicRoughness);
}

bool transmitsAll(const Material& material, const PrimitiveInputs& primitive) {
    return material.transmission.factor == 1.0F &&
           !isReadable(material, primitive, TextureSlot::Transmission);
}

// Returns whether the primitive has neither tangents nor texture coordinates to derive them from.
bool lacksDirection(const PrimitiveInputs& primitive) {
    return !(primitive.hasTangents && primitive.hasNormals) && !primitive.hasTexCoords0 &&
           !primitive.hasTexCoords1;
}

bool hasThickness(const Material& material, const PrimitiveInputs& primitive) {
    const Iridescence& film = material.iridescence;
    return film.thicknessMaximum > 0.0F ||
           (film.thicknessMinimum > 0.0F &&
            isReadable(material, primitive, TextureSlot::IridescenceThickness));
}

}  // namespace

bool isMetal(const Material& material, const PrimitiveInputs& primitive) {
    return material.metallicFactor == 1.0F &&
           !isReadable(material, primitive, TextureSlot::MetallicRoughness);
}

Presence unlit(const Material& material, const PrimitiveInputs&, const KeyOptions&, FeatureMask) {
    return material.unlit ? present() : absent();
}

Presence specularGlossiness(const Material& material, const PrimitiveInputs&, const KeyOptions&,
                            FeatureMask soFar) {
    if (!material.specularGlossiness.given) {
        return absent();
    }
    return has(soFar, Feature::Unlit) ? dropped(kUnlitReadsBaseColor) : present();
}

Presence ior(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
             FeatureMask soFar) {
    return lobe(material.ior.given, soFar,
                {{material.ior.ior == 1.5F, "ior is 1.5, the default"},
                 {isMetal(material, primitive), kFullyMetallic}});
}

Presence specular(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
                  FeatureMask soFar) {
    const bool plain = material.specular.factor == 1.0F && isAll(material.specular.colorFactor, 1.0F) &&
                       !isReadable(material, primitive, TextureSlot::Specular) &&
                       !isReadable(material, primitive, TextureSlot::SpecularColor);
    return lobe(material.specular.given, soFar,
                {{plain, "specularFactor is 1 and specularColorFactor is white"},
                 {isMetal(material, primitive), kFullyMetallic}});
}

Presence clearcoat(const Material& material, const PrimitiveInputs&, const KeyOptions&, FeatureMask soFar) {
    return lobe(material.clearcoat.given, soFar,
                {{material.clearcoat.factor == 0.0F, "clearcoatFactor is 0"}});
}

Presence sheen(const Material& material, const PrimitiveInputs&, const KeyOptions&, FeatureMask soFar) {
    return lobe(material.sheen.given, soFar,
                {{isAll(material.sheen.colorFactor, 0.0F), "sheenColorFactor is black"}});
}

Presence anisotropy(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
                    FeatureMask soFar) {
    // The extension widens alpha along the tangent, from its isotropic value towards 1.
    return lobe(material.anisotropy.given, soFar,
                {{material.anisotropy.strength == 0.0F, "anisotropyStrength is 0"},
                 {isFullyRough(material, primitive), "roughnessFactor is 1: it is 1 in every direction"},
                 {lacksDirection(primitive), "the primitive has neither TANGENT nor texture coordinates"}});
}

Presence iridescence(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
                     FeatureMask soFar) {
    return lobe(material.iridescence.given, soFar,
                {{material.iridescence.factor == 0.0F, "iridescenceFactor is 0"},
                 {material.iridescence.ior == 1.0F, "iridescenceIor is 1, that of the air"},
                 {!hasThickness(material, primitive), "the film is nowhere thicker than 0"}});
}

Presence transmission(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
                      FeatureMask soFar) {
    return lobe(material.transmission.given, soFar,
                {{material.transmission.factor == 0.0F, "transmissionFactor is 0"},
                 {isMetal(material, primitive), kFullyMetallic}});
}

Presence diffuseTransmission(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
                             FeatureMask soFar) {
    return lobe(
        material.diffuseTransmission.given, soFar,
        {{material.diffuseTransmission.factor == 0.0F, "diffuseTransmissionFactor is 0"},
         {isMetal(material, primitive), kFullyMetallic},
         {transmitsAll(material, primitive), "transmissionFactor is 1, which leaves nothing diffuse"}});
}

Presence volume(const Material& material, const PrimitiveInputs&, const KeyOptions&, FeatureMask soFar) {
    const bool transmits = has(soFar, Feature::Transmission) || has(soFar, Feature::DiffuseTransmission);
    return lobe(material.volume.given, soFar,
                {{material.volume.thicknessFactor == 0.0F, "thicknessFactor is 0: thin-walled"},
                 {!transmits, "the key has neither transmission nor diffuseTransmission"}});
}

Presence attenuation(const Material& material, const PrimitiveInputs&, const KeyOptions&, FeatureMask soFar) {
    const bool infinite = material.volume.attenuationDistance == 0.0F;
    const bool white = isAll(material.volume.attenuationColor, 1.0F);
    return lobe(!infinite || !white, soFar,
                {{white, "attenuationColor is white"},
                 {infinite, "attenuationDistance is infinite"},
                 {!has(soFar, Feature::Volume), "the key has no volume"}});
}

Presence dispersion(const Material& material, const PrimitiveInputs&, const KeyOptions&, FeatureMask soFar) {
    return lobe(material.dispersion.given, soFar,
                {{material.dispersion.dispersion == 0.0F, "dispersion is 0"},
                 {material.ior.ior == 1.0F, "ior is 1: nothing refracts"},
                 {!has(soFar, Feature::Volume), "the key has no volume"},
                 {!has(soFar, Feature::Transmission), "the key has no transmission"}});
}

}  // namespace glint::rules

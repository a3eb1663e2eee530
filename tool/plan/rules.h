// The rules of the feature table. A rule says whether shading one (material, primitive) needs a feature, and
// if not, why.
//
// When lobes are left out (KeyOptions::keptLobes), a rule may ask for fewer features, never for more: what
// hits need is part of what primary surfaces need. So a reason to drop a feature may depend on the material,
// or on a feature that is absent from `soFar`, but not on one that is present. The exceptions are Unlit and
// SpecularGlossiness, which are always kept.
#pragma once

#include "plan/features.h"

#include <string>
#include <utility>

namespace glint::rules {

using Rule = Presence(const Material& material, const PrimitiveInputs& primitive, const KeyOptions& options,
                      FeatureMask soFar);

inline constexpr const char* kUnlitReadsBaseColor = "unlit shading reads the base colour alone";

inline bool has(FeatureMask mask, Feature feature) {
    return (mask & bit(feature)) != 0;
}
inline Presence absent() {
    return {};
}
inline Presence present() {
    return {true, {}};
}
inline Presence dropped(std::string reason) {
    return {false, std::move(reason)};
}

// Returns whether the slot has a texture whose UV set the primitive has and Glint reads.
bool isReadable(const Material& material, const PrimitiveInputs& primitive, TextureSlot slot);
// Returns whether the base colour is black everywhere. (With KHR_materials_pbrSpecularGlossiness it is the
// diffuse colour.)
bool isBlack(const Material& material);
// Returns whether the surface is metal everywhere, so that no part of it is a dielectric.
bool isMetal(const Material& material, const PrimitiveInputs& primitive);
// Returns whether hits, or the raster pass, read alpha.
bool isAlphaTested(const Material& material, const PrimitiveInputs& primitive, const KeyOptions& options);

// Lobes (lobe_rules.cpp)
Rule unlit;
Rule specularGlossiness;
Rule ior;
Rule specular;
Rule clearcoat;
Rule sheen;
Rule anisotropy;
Rule iridescence;
Rule transmission;
Rule diffuseTransmission;
Rule volume;
Rule attenuation;
Rule dispersion;

// Textures (texture_rules.cpp)
Rule baseColorTexture;
Rule metallicRoughnessTexture;
Rule normalTexture;
Rule occlusionTexture;
Rule emissiveTexture;
Rule clearcoatSharesNormal;
Rule clearcoatNormalTexture;
Rule textureTransform;

// The rule of a texture that only the given lobe reads.
Presence lobeTexture(const Material& material, const PrimitiveInputs& primitive, FeatureMask soFar,
                     TextureSlot slot, Feature lobe);
template <TextureSlot kSlot, Feature kLobe>
Presence textureOf(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
                   FeatureMask soFar) {
    return lobeTexture(material, primitive, soFar, kSlot, kLobe);
}

bool readsTexCoord(const Material& material, const PrimitiveInputs& primitive, FeatureMask soFar, int set);
template <int kSet>
Presence texCoord(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
                  FeatureMask soFar) {
    return readsTexCoord(material, primitive, soFar, kSet) ? present() : absent();
}

// Other inputs of the surface (input_rules.cpp)
Rule partialMetal;
Rule emissiveStrength;
Rule vertexColor;
Rule normals;
Rule tangents;
Rule doubleSided;
Rule alphaMask;

}  // namespace glint::rules

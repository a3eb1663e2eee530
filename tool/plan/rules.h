// The rules of the feature table: whether shading one (material, primitive) needs a feature, and if not, why.
//
// A rule may ask for less, never for more, when lobes are left out (KeyOptions::keptLobes): what hits need is
// part of what primary surfaces need. So a reason to drop may lie in the material or in a feature that is
// absent from `soFar`, not in one that is present; the exceptions are Unlit and SpecularGlossiness, which are
// always kept.
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

// Whether the slot has a texture whose UV set the primitive has and Glint reads.
bool isReadable(const Material& material, const PrimitiveInputs& primitive, TextureSlot slot);
// Whether the base colour (of KHR_materials_pbrSpecularGlossiness: the diffuse colour) is black everywhere.
bool isBlack(const Material& material);
// Whether hits, or the raster pass, read alpha.
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

// A texture that only the lobe reads.
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

// What else the surface is read from (input_rules.cpp)
Rule emissiveStrength;
Rule vertexColor;
Rule normals;
Rule tangents;
Rule doubleSided;
Rule alphaMask;

}  // namespace glint::rules

// The table of features: what shading can depend on, declared once. Everything else is derived from it: GLSL
// macros, names in the manifest and the C++ header, keys.
#pragma once

#include "plan/material.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// A set of features. Low 32 bits: lobes; high 32 bits: inputs.
using FeatureMask = std::uint64_t;

// Bit numbers. To add a feature: add it here and a row to the table in features.cpp; nothing else changes,
// but scripts/measure_merge_model.py measures what it costs.
//
//   bits  0..31  lobes: what light does at the surface; keys with the same lobes are one family
//   bits 32..63  inputs: what the surface's parameters are read from
enum class Feature : std::uint8_t {
    Unlit = 0,
    SpecularGlossiness,
    Ior,
    Specular,
    Clearcoat,
    Sheen,
    Anisotropy,
    Iridescence,
    Transmission,
    DiffuseTransmission,
    Volume,       // not thin-walled: light refracts
    Attenuation,  // the volume absorbs
    Dispersion,
    BaseColorTexture = 32,
    MetallicRoughnessTexture,
    NormalTexture,
    OcclusionTexture,
    EmissiveTexture,
    EmissiveStrength,
    TexCoord0,
    TexCoord1,
    TextureTransform,
    VertexColor,
    Normals,
    Tangents,
    DoubleSided,
    AlphaMask,
    ClearcoatTexture,
    ClearcoatRoughnessTexture,
    ClearcoatNormalTexture,
    ClearcoatSharesNormal,  // the coat's normal texture is that of the base: read once
    SheenColorTexture,
    SheenRoughnessTexture,
    AnisotropyTexture,
    SpecularTexture,
    SpecularColorTexture,
    IridescenceTexture,
    IridescenceThicknessTexture,
    TransmissionTexture,
    ThicknessTexture,
    DiffuseTransmissionTexture,
    DiffuseTransmissionColorTexture,
};

constexpr FeatureMask bit(Feature feature) {
    return FeatureMask{1} << static_cast<unsigned>(feature);
}

inline constexpr FeatureMask kLobeMask = 0xFFFFFFFFULL;

enum class AlphaPolicy : std::uint8_t { Opaque, Tested };

struct KeyOptions {
    AlphaPolicy alpha = AlphaPolicy::Opaque;
    // Lobes that may be in a key; a lobe left out takes the inputs with it that nothing else reads.
    FeatureMask keptLobes = kLobeMask;
};

// What a feature's rule says of one (material, primitive).
struct Presence {
    bool present = false;
    // Not empty: the file asks for the feature, and this is why it is not in the key.
    std::string droppedBecause;
};

// A row reads in this order, and there is one table.
// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding)
struct FeatureInfo {
    Feature feature;
    std::string_view name;       // in the manifest: "baseColorTexture"
    std::string_view shortName;  // part of a case's name: "BaseTex"
    std::string_view macro;      // in GLSL: "GLINT_BASE_COLOR_TEXTURE"
    std::string_view gltf;       // where it stands in glTF
    std::string_view neutral;    // when it is there and changes nothing
    // The rule. `soFar` holds the features of earlier rows that are present.
    Presence (*rule)(const Material&, const PrimitiveInputs&, const KeyOptions&, FeatureMask soFar);
};

// In order of evaluation, which is the order of the table's rows, not that of the bits.
std::span<const FeatureInfo> featureTable();

// Names of the features of `mask` in order of bits.
std::vector<std::string_view> featureNames(FeatureMask mask);

// "#define GLINT_BASE_COLOR_TEXTURE 0x1u" for every feature, lobes and inputs numbered within their own word.
std::string featureDefines();

}  // namespace glint

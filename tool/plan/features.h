// The table of features that shading can depend on. Each is declared once, and everything else is derived
// from it: GLSL macros, names in the manifest and the C++ header, keys.
#pragma once

#include "plan/material.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// A set of features. The low 32 bits are lobes, the high 32 bits are inputs.
using FeatureMask = std::uint64_t;

// Bit numbers. To add a feature, add it here and add a row to the table in features.cpp. Nothing else
// changes, but scripts/measure_merge_model.py must measure what it costs.
//
//   bits  0..31  lobes: what light does at the surface; keys with the same lobes are one family
//   bits 32..63  inputs: where the surface's parameters are read from
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
    ClearcoatSharesNormal,  // The coat uses the base's normal texture, which is read once.
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
    PartialMetal,  // The base is neither all metal nor all dielectric: both are shaded.
};

constexpr FeatureMask bit(Feature feature) {
    return FeatureMask{1} << static_cast<unsigned>(feature);
}

inline constexpr FeatureMask kLobeMask = 0xFFFFFFFFULL;

enum class AlphaPolicy : std::uint8_t { Opaque, Tested };

struct KeyOptions {
    AlphaPolicy alpha = AlphaPolicy::Opaque;
    // The lobes that a key may have. If a lobe is left out, inputs that only this lobe reads are left out
    // too.
    FeatureMask keptLobes = kLobeMask;
};

// The answer of a feature's rule for one (material, primitive).
struct Presence {
    bool present = false;
    // If not empty, the file asks for the feature, and this is the reason why the key lacks it.
    std::string droppedBecause;
};

// Members stand in the order in which a row reads; padding is harmless, as there is only one table.
// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding)
struct FeatureInfo {
    Feature feature;
    std::string_view name;       // name in the manifest: "baseColorTexture"
    std::string_view shortName;  // part of a case's name: "BaseTex"
    std::string_view macro;      // macro in GLSL: "GLINT_BASE_COLOR_TEXTURE"
    std::string_view gltf;       // its place in glTF
    std::string_view neutral;    // when it is given but changes nothing
    // The rule that decides. `soFar` holds the features of earlier rows that are present.
    Presence (*rule)(const Material&, const PrimitiveInputs&, const KeyOptions&, FeatureMask soFar);
};

// Rows come in the order of evaluation, which is not the order of the bits.
std::span<const FeatureInfo> featureTable();

// Returns the names of the features of `mask`, in the order of bits.
std::vector<std::string_view> featureNames(FeatureMask mask);

// Returns "#define GLINT_BASE_COLOR_TEXTURE 0x1u" for every feature; lobes and inputs are numbered within
// their own word.
std::string featureDefines();

}  // namespace glint

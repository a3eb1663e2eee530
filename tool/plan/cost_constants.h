// Made by scripts/fit_merge_model.py from scripts/merge_model.csv; run it again rather than edit this.
//
// Fitted to 200 shaders of one key and 37 that branch, less a quarter of the random ones. On that quarter
// the model is off, in instructions, and in texture fetches:
//
//                shaders  mean error  largest      R2  fetches, most
//     one key         29        4.3 %     27.3 %   0.969           0.0
//     branches        10        3.9 %      6.7 %   0.988           0.0
//
// The mean and the largest error are relative; R2 is that of the instructions.
#pragma once

#include "plan/features.h"

namespace glint::fitted {

// SPIR-V instructions of the shader of one unlit key without other features, and what being lit adds.
inline constexpr double kUnlitInstructions = 69.0;
inline constexpr double kLitInstructions = 603.0;

// What a shader has beyond its features' own code for each feature that it branches on.
inline constexpr double kInputBranch = 27.0;
inline constexpr double kLobeBranch = 163.0;

// What a shader has more for a feature; nothing for those that are not listed.
struct FeatureCode {
    Feature feature;
    double instructions;
    double fetches;
};

inline constexpr FeatureCode kFeatureCode[] = {
    {Feature::Anisotropy, 182.0, 0.0},
    {Feature::AnisotropyTexture, 80.0, 1.0},
    {Feature::Attenuation, 0.0, 0.0},
    {Feature::BaseColorTexture, 75.0, 1.0},
    {Feature::Clearcoat, 315.0, 0.0},
    {Feature::ClearcoatNormalTexture, 165.0, 1.0},
    {Feature::ClearcoatRoughnessTexture, 44.0, 1.0},
    {Feature::ClearcoatSharesNormal, 0.0, 0.0},
    {Feature::ClearcoatTexture, 26.0, 1.0},
    {Feature::DiffuseTransmission, 98.0, 0.0},
    {Feature::DiffuseTransmissionColorTexture, 15.0, 1.0},
    {Feature::DiffuseTransmissionTexture, 23.0, 1.0},
    {Feature::Dispersion, 1172.0, 0.0},
    {Feature::DoubleSided, 19.0, 0.0},
    {Feature::EmissiveStrength, 2.0, 0.0},
    {Feature::EmissiveTexture, 45.0, 1.0},
    {Feature::Ior, 15.0, 0.0},
    {Feature::Iridescence, 266.0, 0.0},
    {Feature::IridescenceTexture, 49.0, 1.0},
    {Feature::IridescenceThicknessTexture, 69.0, 1.0},
    {Feature::MetallicRoughnessTexture, 43.0, 1.0},
    {Feature::NormalTexture, 134.0, 1.0},
    {Feature::Normals, 0.0, 0.0},
    {Feature::OcclusionTexture, 61.0, 1.0},
    {Feature::PartialMetal, 4.0, 0.0},
    {Feature::Sheen, 215.0, 0.0},
    {Feature::SheenColorTexture, 69.0, 1.0},
    {Feature::SheenRoughnessTexture, 64.0, 1.0},
    {Feature::Specular, 6.0, 0.0},
    {Feature::SpecularColorTexture, 45.0, 1.0},
    {Feature::SpecularGlossiness, 0.0, 0.0},
    {Feature::SpecularTexture, 30.0, 1.0},
    {Feature::Tangents, 25.0, 0.0},
    {Feature::TexCoord0, 132.0, 0.0},
    {Feature::TexCoord1, 111.0, 0.0},
    {Feature::TextureTransform, 17.0, 0.0},
    {Feature::ThicknessTexture, 0.0, 1.0},
    {Feature::Transmission, 161.0, 0.0},
    {Feature::TransmissionTexture, 39.0, 1.0},
    {Feature::VertexColor, 28.0, 0.0},
    {Feature::Volume, 420.0, 0.0},
};

}  // namespace glint::fitted

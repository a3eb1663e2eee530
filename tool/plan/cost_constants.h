// Made by scripts/fit_merge_model.py from scripts/merge_model.csv; run it again rather than edit this.
//
// Fitted to 201 shaders of one key and 38 that branch, less a quarter of the random ones. On that quarter
// the model is off, in instructions, and in texture fetches:
//
//                shaders  mean error  largest      R2  fetches, most
//     one key         30        5.2 %     25.5 %   0.959           0.0
//     branches        10        5.8 %     14.0 %   0.980           0.0
//
// The mean and the largest error are relative; R2 is that of the instructions.
#pragma once

#include "plan/features.h"

namespace glint::fitted {

// SPIR-V instructions of the shader of one unlit key without other features, and what being lit adds.
inline constexpr double kUnlitInstructions = 74.0;
inline constexpr double kLitInstructions = 654.0;

// What a shader has beyond its features' own code for each feature that it branches on.
inline constexpr double kInputBranch = 21.0;
inline constexpr double kLobeBranch = 142.0;

// What a shader has more for a feature; nothing for those that are not listed.
struct FeatureCode {
    Feature feature;
    double instructions;
    double fetches;
};

inline constexpr FeatureCode kFeatureCode[] = {
    {Feature::Anisotropy, 193.0, 0.0},
    {Feature::AnisotropyTexture, 89.0, 1.0},
    {Feature::Attenuation, 75.0, 0.0},
    {Feature::BaseColorTexture, 79.0, 1.0},
    {Feature::Clearcoat, 306.0, 0.0},
    {Feature::ClearcoatNormalTexture, 164.0, 1.0},
    {Feature::ClearcoatRoughnessTexture, 57.0, 1.0},
    {Feature::ClearcoatSharesNormal, 27.0, 0.0},
    {Feature::ClearcoatTexture, 49.0, 1.0},
    {Feature::DiffuseTransmission, 87.0, 0.0},
    {Feature::DiffuseTransmissionColorTexture, 17.0, 1.0},
    {Feature::DiffuseTransmissionTexture, 26.0, 1.0},
    {Feature::Dispersion, 1168.0, 0.0},
    {Feature::DoubleSided, 14.0, 0.0},
    {Feature::EmissiveStrength, 0.0, 0.0},
    {Feature::EmissiveTexture, 41.0, 1.0},
    {Feature::Ior, 25.0, 0.0},
    {Feature::Iridescence, 231.0, 0.0},
    {Feature::IridescenceTexture, 58.0, 1.0},
    {Feature::IridescenceThicknessTexture, 37.0, 1.0},
    {Feature::MetallicRoughnessTexture, 48.0, 1.0},
    {Feature::NormalTexture, 124.0, 1.0},
    {Feature::Normals, 0.0, 0.0},
    {Feature::OcclusionTexture, 41.0, 1.0},
    {Feature::Sheen, 226.0, 0.0},
    {Feature::SheenColorTexture, 50.0, 1.0},
    {Feature::SheenRoughnessTexture, 47.0, 1.0},
    {Feature::Specular, 0.0, 0.0},
    {Feature::SpecularColorTexture, 44.0, 1.0},
    {Feature::SpecularGlossiness, 0.0, 0.0},
    {Feature::SpecularTexture, 53.0, 1.0},
    {Feature::Tangents, 34.0, 0.0},
    {Feature::TexCoord0, 129.0, 0.0},
    {Feature::TexCoord1, 94.0, 0.0},
    {Feature::TextureTransform, 12.0, 0.0},
    {Feature::ThicknessTexture, 21.0, 1.0},
    {Feature::Transmission, 163.0, 0.0},
    {Feature::TransmissionTexture, 31.0, 1.0},
    {Feature::VertexColor, 28.0, 0.0},
    {Feature::Volume, 353.0, 0.0},
};

}  // namespace glint::fitted

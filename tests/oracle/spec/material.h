// The parameters of a glTF material as the specification defines them, read from its JSON a second time: with
// defaults, channels and colour spaces from the text of glTF 2.0 (section 3.9) and of each extension. Nothing
// here comes from the shaders or from Glint's importer.
#pragma once

#include "oracle/vectors.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace glint::spec {

using oracle::kPi;
using oracle::squared;
using oracle::Vec2;
using oracle::Vec3;
using Json = nlohmann::json;

// The only texel of a texture, as the image stores it.
using Texel = std::array<std::uint8_t, 4>;

struct Material {
    Vec3 baseColor{1.0};
    double metallic = 1.0;
    double roughness = 1.0;
    Vec3 emission{0.0};
    double occlusion = 1.0;
    // The normals of the normal texture and of the coat's, in the space of tangent, bitangent and normal.
    Vec3 normal{0.0, 0.0, 1.0};
    Vec3 clearcoatNormal{0.0, 0.0, 1.0};
    // KHR_materials_pbrSpecularGlossiness. Its diffuse colour is `baseColor`, its F0 is `specularColor`.
    bool specularGlossiness = false;
    double ior = 1.5;
    double specular = 1.0;
    Vec3 specularColor{1.0};
    double clearcoat = 0.0;
    double clearcoatRoughness = 0.0;
    Vec3 sheenColor{0.0};
    double sheenRoughness = 0.0;
    double anisotropy = 0.0;
    Vec2 anisotropyDirection{1.0, 0.0};  // unit, in the space of tangent and bitangent
    double iridescence = 0.0;
    double iridescenceIor = 1.3;
    double iridescenceThickness = 400.0;  // nanometres
    double transmission = 0.0;
    double diffuseTransmission = 0.0;
    Vec3 diffuseTransmissionColor{1.0};
    double thickness = 0.0;  // metres at the surface
    bool volume = false;     // thicknessFactor is above 0
    Vec3 absorption{0.0};    // per metre
    double dispersion = 0.0;

    // The alphas along the direction of anisotropy and across it: KHR_materials_anisotropy, "Anisotropy".
    Vec2 alpha() const;
};

// Reads an element of the file's "materials". Texture `index` has the texel `texels[index]`, whatever its
// coordinates.
Material readMaterial(const Json& material, const std::vector<Texel>& texels);

}  // namespace glint::spec

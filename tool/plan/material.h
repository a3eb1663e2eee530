// The material model that planning reads: core glTF 2.0 and the extensions that Glint shades. Plain data.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace glint {

// The texture slots, in the order of MaterialRecord::textures (shaders/interop/scene.h).
// KHR_materials_pbrSpecularGlossiness keeps its diffuse texture in BaseColor and its other texture in
// MetallicRoughness.
enum class TextureSlot : std::uint8_t {
    BaseColor,
    MetallicRoughness,
    Normal,
    Occlusion,
    Emissive,
    Clearcoat,
    ClearcoatRoughness,
    ClearcoatNormal,
    SheenColor,
    SheenRoughness,
    Anisotropy,
    Specular,
    SpecularColor,
    Iridescence,
    IridescenceThickness,
    Transmission,
    Thickness,
    DiffuseTransmission,
    DiffuseTransmissionColor,
    Count
};
inline constexpr std::size_t kTextureSlots = static_cast<std::size_t>(TextureSlot::Count);

// KHR_texture_transform: uv' = T(offset) R(rotation) S(scale) uv; rotation in radians, counter-clockwise.
struct TextureTransform {
    std::array<float, 2> offset{0.0F, 0.0F};
    float rotation = 0.0F;
    std::array<float, 2> scale{1.0F, 1.0F};
};

struct TextureInfo {
    int texture = -1;  // index into Scene::textures; -1 where the slot is empty
    int texCoord = 0;  // the UV set; the extension's override is already applied
    TextureTransform transform;
    bool hasTransform = false;  // The file gives KHR_texture_transform here, even if it is the identity.
};

// The extensions that change what light does at the surface. `given` says that the file has the extension,
// even if its values are neutral.

struct SpecularGlossiness {  // KHR_materials_pbrSpecularGlossiness; its diffuseFactor is baseColorFactor
    bool given = false;
    std::array<float, 3> specularFactor{1.0F, 1.0F, 1.0F};
    float glossinessFactor = 1.0F;
};

struct Ior {  // KHR_materials_ior
    bool given = false;
    float ior = 1.5F;  // at least 1, or 0 for a surface that reflects everything
};

struct Specular {  // KHR_materials_specular
    bool given = false;
    float factor = 1.0F;
    std::array<float, 3> colorFactor{1.0F, 1.0F, 1.0F};  // may exceed 1
};

struct Clearcoat {  // KHR_materials_clearcoat
    bool given = false;
    float factor = 0.0F;
    float roughnessFactor = 0.0F;
    float normalScale = 1.0F;
};

struct Sheen {  // KHR_materials_sheen
    bool given = false;
    std::array<float, 3> colorFactor{0.0F, 0.0F, 0.0F};
    float roughnessFactor = 0.0F;
};

struct Anisotropy {  // KHR_materials_anisotropy
    bool given = false;
    float strength = 0.0F;
    float rotation = 0.0F;  // radians, counter-clockwise from the tangent
};

struct Iridescence {  // KHR_materials_iridescence
    bool given = false;
    float factor = 0.0F;
    float ior = 1.3F;
    float thicknessMinimum = 100.0F;  // nanometres
    float thicknessMaximum = 400.0F;
};

struct Transmission {  // KHR_materials_transmission
    bool given = false;
    float factor = 0.0F;
};

struct DiffuseTransmission {  // KHR_materials_diffuse_transmission
    bool given = false;
    float factor = 0.0F;
    std::array<float, 3> colorFactor{1.0F, 1.0F, 1.0F};
};

struct Volume {  // KHR_materials_volume
    bool given = false;
    float thicknessFactor = 0.0F;      // metres in the space of the mesh; 0 for thin-walled
    float attenuationDistance = 0.0F;  // metres; 0 means infinite absorption distance
    std::array<float, 3> attenuationColor{1.0F, 1.0F, 1.0F};
};

struct Dispersion {  // KHR_materials_dispersion
    bool given = false;
    float dispersion = 0.0F;  // 20 / Abbe number
};

enum class AlphaMode : std::uint8_t { Opaque, Mask, Blend };

// Default member values are the defaults of the glTF specification.
struct Material {
    std::string name;
    std::array<float, 4> baseColorFactor{1.0F, 1.0F, 1.0F, 1.0F};  // linear
    float metallicFactor = 1.0F;
    float roughnessFactor = 1.0F;
    std::array<float, 3> emissiveFactor{0.0F, 0.0F, 0.0F};  // linear
    float emissiveStrength = 1.0F;                          // KHR_materials_emissive_strength
    bool hasEmissiveStrength = false;                       // The file gives the extension, even if its value
                                                            // is 1.
    float normalScale = 1.0F;
    float occlusionStrength = 1.0F;
    float alphaCutoff = 0.5F;
    AlphaMode alphaMode = AlphaMode::Opaque;
    bool doubleSided = false;
    bool unlit = false;  // KHR_materials_unlit
    SpecularGlossiness specularGlossiness;
    Ior ior;
    Specular specular;
    Clearcoat clearcoat;
    Sheen sheen;
    Anisotropy anisotropy;
    Iridescence iridescence;
    Transmission transmission;
    DiffuseTransmission diffuseTransmission;
    Volume volume;
    Dispersion dispersion;
    std::array<TextureInfo, kTextureSlots> textures;
    // Material extensions that the file uses for this material and that Glint does not shade.
    std::vector<std::string> unsupportedExtensions;

    const TextureInfo& texture(TextureSlot slot) const {
        return textures[static_cast<std::size_t>(slot)];
    }
    TextureInfo& texture(TextureSlot slot) {
        return textures[static_cast<std::size_t>(slot)];
    }
};

// Whether the slot's texture is colour, in sRGB; its alpha, where something reads that, is linear all the
// same.
inline bool isColor(const Material& material, TextureSlot slot) {
    switch (slot) {
        case TextureSlot::BaseColor:
        case TextureSlot::Emissive:
        case TextureSlot::SheenColor:
        case TextureSlot::SpecularColor:
        case TextureSlot::DiffuseTransmissionColor:
            return true;
        case TextureSlot::MetallicRoughness:
            return material.specularGlossiness.given;
        default:
            return false;
    }
}

enum class ColorContent : std::uint8_t {
    None,   // no COLOR_0
    White,  // COLOR_0 is (1, 1, 1, 1) everywhere, so it changes nothing.
    Varying
};

// The facts about a primitive that planning needs: its material and which attributes it has.
struct PrimitiveInputs {
    int mesh = 0;       // index into Scene::meshes
    int primitive = 0;  // within the mesh
    int material = 0;   // always valid
    bool hasNormals = false;
    bool hasTangents = false;
    bool hasTexCoords0 = false;
    bool hasTexCoords1 = false;
    ColorContent colors = ColorContent::None;
    double expectedHits = 0.0;  // in proportion to those of other primitives; all are 0 if nothing is known
};

}  // namespace glint

// The material model that planning reads: glTF 2.0 core and the extensions that Glint shades. Plain data.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace glint {

// Texture slots, in the order of MaterialRecord::textures (shaders/interop/scene.h).
enum class TextureSlot : std::uint8_t { BaseColor, MetallicRoughness, Normal, Occlusion, Emissive, Count };
inline constexpr std::size_t kTextureSlots = static_cast<std::size_t>(TextureSlot::Count);

// KHR_texture_transform: uv' = T(offset) R(rotation) S(scale) uv; rotation in radians, counter-clockwise.
struct TextureTransform {
    std::array<float, 2> offset{0.0F, 0.0F};
    float rotation = 0.0F;
    std::array<float, 2> scale{1.0F, 1.0F};
};

struct TextureInfo {
    int texture = -1;  // index into Scene::textures; -1 where the slot is empty
    int texCoord = 0;  // the UV set, the extension's override already applied
    TextureTransform transform;
    bool hasTransform = false;  // the file gives KHR_texture_transform here, identity or not
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
    bool hasEmissiveStrength = false;                       // the file gives the extension, 1 or not
    float normalScale = 1.0F;
    float occlusionStrength = 1.0F;
    float alphaCutoff = 0.5F;
    AlphaMode alphaMode = AlphaMode::Opaque;
    bool doubleSided = false;
    bool unlit = false;  // KHR_materials_unlit
    std::array<TextureInfo, kTextureSlots> textures;
    // Material extensions that the file uses here and that Glint does not shade yet.
    std::vector<std::string> unsupportedExtensions;

    const TextureInfo& texture(TextureSlot slot) const {
        return textures[static_cast<std::size_t>(slot)];
    }
    TextureInfo& texture(TextureSlot slot) {
        return textures[static_cast<std::size_t>(slot)];
    }
};

enum class ColorContent : std::uint8_t {
    None,   // no COLOR_0
    White,  // COLOR_0 is (1, 1, 1, 1) everywhere: it changes nothing
    Varying
};

// What planning knows of a primitive: its material and which attributes it has.
struct PrimitiveInputs {
    int mesh = 0;       // index into Scene::meshes
    int primitive = 0;  // within the mesh
    int material = 0;   // always valid
    bool hasNormals = false;
    bool hasTangents = false;
    bool hasTexCoords0 = false;
    bool hasTexCoords1 = false;
    ColorContent colors = ColorContent::None;
};

}  // namespace glint

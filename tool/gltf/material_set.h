// Materials without a scene, which a program makes in C++. A list of materials in JSON fills the same type:
// docs/material_lists.md. Names are those of the declarations of features, Glint's and those of packs. A
// mistake is an error of importMaterials(), which names its place as in the JSON:
// "materials#/materials/3/values/roughnessFactor".
#pragma once

#include "gltf/import_options.h"
#include "gltf/scene.h"
#include "materials/material.h"

#include <glint/result.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace glint::gltf {

struct TextureDescription {
    std::string file{};  // relative to the folder of MaterialSet::path; empty: the program gives the texels
    // The name of an image that the program gives, for its own use. Empty: that of the texture.
    std::string name{};
    std::uint32_t texCoord = 0;  // the UV set: 0 or 1
    // The UVs are scaled, rotated and moved, in this order, as in KHR_texture_transform.
    std::array<double, 2> offset{};
    std::array<double, 2> scale{1.0, 1.0};
    double rotation = 0.0;  // radians
};

// A parameter that the program may set while the package is in use. No feature is left out for its value.
struct EditedParameter {
    std::string parameter{};
    // The least and the greatest value of each of its channels. Without it: the range of its declaration.
    std::optional<std::array<double, 2>> range{};
};

struct MaterialDescription {
    std::string name{};
    std::string model{};                  // the declaration of its base; empty: "metallicRoughness"
    std::vector<std::string> features{};  // features that it asks for without a value: "unlit"
    // By parameter: a number for each of its channels, in the unit of its declaration. Others have their
    // default.
    std::map<std::string, std::vector<double>> values{};
    std::map<std::string, TextureDescription> textures{};  // by texture: "baseColorTexture"
    std::vector<EditedParameter> edited{};
    // The attributes that the vertices of all its surfaces have beside positions, as in glTF. Empty: NORMAL
    // and TEXCOORD_0.
    std::vector<std::string> attributes{};
    materials::AlphaMode alphaMode = materials::AlphaMode::Opaque;
    bool doubleSided = false;
    double weight = 1.0;  // its share of the hits, relative to the others: 1e-6 to 1e6
};

struct MaterialSet {
    // The stem is the scene's name in the package, and the folder is that of the files of textures. There
    // need not be such a file.
    std::filesystem::path path = "materials";
    std::vector<MaterialDescription> materials{};  // at least one
};

// Returns a scene with a sphere for each material: material i is that of mesh i, primitive 0. A light stands
// for those of the program. `options` are those of importScene(), whose errors about images and materials it
// has. Error "material-list": a name that no declaration has, or a value that is not allowed.
Result<Scene> importMaterials(const MaterialSet& set, const ImportOptions& options = {});

}  // namespace glint::gltf

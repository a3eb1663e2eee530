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
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace glint::gltf {

// A value of a parameter, in the form that JSON has: a number in the unit of its declaration, true or false,
// the name of an enum's value, or a list of these: {0.8, 0.5, 0.2}, {{1, 0, 0}, {0, 1, 0}}. A list of one
// number stands for the number, too.
class ParameterInput {
public:
    using List = std::vector<ParameterInput>;

    ParameterInput() = default;  // an empty list
    template <typename Number>
    requires std::is_arithmetic_v<Number> ParameterInput(Number number) {
        if constexpr (std::same_as<Number, bool>) {
            value_ = number;
        } else {
            value_ = static_cast<double>(number);
        }
    }
    ParameterInput(std::string name) : value_(std::move(name)) {}
    ParameterInput(const char* name) : value_(std::string(name)) {}
    ParameterInput(std::initializer_list<ParameterInput> list) : value_(List(list)) {}
    explicit ParameterInput(List list) : value_(std::move(list)) {}
    ParameterInput(const std::vector<double>& numbers) : value_(List(numbers.begin(), numbers.end())) {}

    const std::variant<List, double, bool, std::string>& value() const {
        return value_;
    }

private:
    std::variant<List, double, bool, std::string> value_;
};

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
    // The least and the greatest of each of its numbers. Without it: the range of its declaration. A value of
    // a bool or an enum has none.
    std::optional<std::array<double, 2>> range{};
};

struct MaterialDescription {
    std::string name{};
    std::string model{};                  // the declaration of its base; empty: "metallicRoughness"
    std::vector<std::string> features{};  // features that it asks for without a value: "unlit"
    std::map<std::string, ParameterInput> values{};        // by parameter; others have their default
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

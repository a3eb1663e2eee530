// Materials without a scene: lists of them in JSON, and files of MaterialX, fill a MaterialSet, and a set
// becomes a document of glTF, so that all that reads scenes reads sets. docs/material_lists.md describes both
// formats.
#pragma once

#include "base/fields_fwd.h"
#include "base/files.h"
#include "base/json.h"
#include "gltf/document/files.h"
#include "gltf/document/schema.h"
#include "gltf/material_set.h"
#include "materials/interval.h"
#include "materials/material_model.h"

#include <glint/result.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace glint::gltf {

// ---- Lists (material_list.cpp) ----

// By AlphaMode, as in glTF.
inline constexpr std::string_view kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};

base::Fields fieldsOf(const TextureDescription* none);
base::Fields fieldsOf(const EditedParameter* none);
base::Fields fieldsOf(const MaterialDescription* none);
base::Fields fieldsOf(const MaterialSet* none);

// Returns a value as JSON of either type.
template <typename AnyJson>
AnyJson toJson(const ParameterInput& input) {
    return std::visit(
        [](const auto& value) -> AnyJson {
            if constexpr (std::is_same_v<std::decay_t<decltype(value)>, ParameterInput::List>) {
                AnyJson list = AnyJson::array();
                for (const ParameterInput& element : value) {
                    list.push_back(toJson<AnyJson>(element));
                }
                return list;
            } else {
                return value;
            }
        },
        input.value());
}

bool isMaterialList(const Json& json);
// Collects errors "material-list" of the set or list with this path.
base::JsonReader materialListReader(const std::filesystem::path& path);
// `text` is that of the file `path`. Error "material-list".
Result<MaterialSet> readMaterialList(ByteView text, const std::filesystem::path& path);
// Returns the first value of a set that a list could not have: error "material-list".
Status checkMaterialSet(const MaterialSet& set);

// ---- MaterialX files with one surface of OpenPBR or Standard Surface (materialx.cpp) ----

// Returns whether the text is XML with a root of MaterialX.
bool isMaterialX(ByteView text);
// `text` is that of the file `path`. Error: "materialx".
Result<MaterialSet> readMaterialX(ByteView text, const std::filesystem::path& path,
                                  const materials::MaterialModel& model);

// ---- Sets as documents (material_expansion.cpp) ----

// A parameter of a material that may be anything in a range.
struct EditedValue {
    int material = 0;
    int parameter = 0;  // index into MaterialModel::parameters
    materials::ValueInterval range;
    std::string pointer;  // in the list
};

// Moving the Json can't throw here. NOLINTNEXTLINE(bugprone-exception-escape)
struct ExpandedMaterials {
    Json document;
    base::Bytes buffer;  // the document's only buffer
    // The list's pointers of what has another one in the document:
    // "/materials/0/extensions/KHR_materials_sheen/…".
    std::map<std::string, std::string, std::less<>> places;
    std::vector<EditedValue> edited;  // by ascending material
};

// A member of images of such a document whose texels are given at run time.
inline constexpr const char* kAtRunTime = "glintAtRunTime";

// Makes a sphere for each material, whose area follows its weight. Requires checkMaterialSet(). Error
// "material-list".
Result<ExpandedMaterials> expandMaterials(const MaterialSet& set, const materials::MaterialModel& model);

}  // namespace glint::gltf

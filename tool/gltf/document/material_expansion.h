// Makes a document of glTF of a set of materials, so that all that reads scenes reads sets: a sphere for each
// material, whose area follows its weight.
#pragma once

#include "base/files.h"
#include "gltf/document/schema.h"
#include "gltf/material_set.h"
#include "materials/interval.h"
#include "materials/material_model.h"

#include <glint/result.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace glint::gltf {

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

// Requires checkMaterialSet(). Error "material-list".
Result<ExpandedMaterials> expandMaterials(const MaterialSet& set, const materials::MaterialModel& model);

}  // namespace glint::gltf

// The format of lists of materials: JSON that fills a MaterialSet. docs/material_lists.md describes it.
#pragma once

#include "base/fields_fwd.h"
#include "base/json.h"
#include "gltf/document/files.h"
#include "gltf/document/schema.h"
#include "gltf/material_set.h"

#include <glint/result.h>

#include <filesystem>
#include <string_view>

namespace glint::gltf {

// By AlphaMode, as in glTF.
inline constexpr std::string_view kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};

base::Fields fieldsOf(const TextureDescription* none);
base::Fields fieldsOf(const EditedParameter* none);
base::Fields fieldsOf(const MaterialDescription* none);
base::Fields fieldsOf(const MaterialSet* none);

bool isMaterialList(const Json& json);
// Collects errors "material-list" of the set or list with this path.
base::JsonReader materialListReader(const std::filesystem::path& path);
// `text` is that of the file `path`. Error "material-list".
Result<MaterialSet> readMaterialList(ByteView text, const std::filesystem::path& path);
// Returns the first value of a set that a list could not have: error "material-list".
Status checkMaterialSet(const MaterialSet& set);

}  // namespace glint::gltf

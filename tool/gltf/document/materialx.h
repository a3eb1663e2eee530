// MaterialX files with one surface of OpenPBR or Standard Surface. Such a file becomes a list of materials
// (material_list.h): docs/material_lists.md.
#pragma once

#include "gltf/document/files.h"
#include "materials/material_model.h"

#include <glint/result.h>

#include <filesystem>

namespace glint::gltf {

// Returns whether the text is XML with a root of MaterialX.
bool isMaterialX(ByteView text);
// Returns the text of the list. `text` is that of the file `path`. Error: "materialx".
Result<base::Bytes> listOfMaterialX(ByteView text, const std::filesystem::path& path,
                                    const materials::MaterialModel& model);

}  // namespace glint::gltf

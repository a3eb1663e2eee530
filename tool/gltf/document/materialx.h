// MaterialX files with one surface of OpenPBR or Standard Surface. Such a file becomes a set of one
// material: docs/material_lists.md.
#pragma once

#include "gltf/document/files.h"
#include "gltf/material_set.h"
#include "materials/material_model.h"

#include <glint/result.h>

#include <filesystem>

namespace glint::gltf {

// Returns whether the text is XML with a root of MaterialX.
bool isMaterialX(ByteView text);
// `text` is that of the file `path`. Error: "materialx".
Result<MaterialSet> readMaterialX(ByteView text, const std::filesystem::path& path,
                                  const materials::MaterialModel& model);

}  // namespace glint::gltf

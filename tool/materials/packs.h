// Packs: material features of a user's own, beside those that Glint has.
#pragma once

#include "materials/material_model.h"

#include <glint/result.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace glint::materials {

// Returns the files of the packs in `folders`: each folder's own declarations (.json) and GLSL (.glsl), and
// those of the folders in it, sorted by name. Error "materials-folder" if one can't be listed or has no
// declaration.
Result<std::vector<std::filesystem::path>> packFiles(std::span<const std::string> folders);

// Returns the model of Glint's own features together with those of the packs. It lives as long as the
// program, as materials refer to it. Without folders it is builtinMaterialModel(). Has the errors of
// packFiles(), readFile() and readDeclarations(), and "materials-glsl" if a file that a declaration names is
// not there.
Result<const MaterialModel*> loadMaterialModel(std::span<const std::string> folders);

}  // namespace glint::materials

// Reads the declarations of material features and effects: the JSON of
// shaders/materials/<feature>/<feature>.json and shaders/effects/<effect>/<effect>.json, whose members
// docs/schemas/material_feature.json and docs/schemas/effect.json describe.
#pragma once

#include "materials/declaration_files.h"
#include "materials/material_model.h"

#include <glint/result.h>

#include <span>
#include <string_view>

namespace glint::materials {

// Makes the model of all files together, as they may refer to each other. The result depends on neither the
// order of the files nor their folders. Error "declaration": a file is no JSON, has unknown or missing
// members, uses a name twice, refers to one that does not exist, or has an expression that can't be read; the
// place is file#/json/pointer.
Result<MaterialModel> readDeclarations(std::span<const DeclarationFile> files);

}  // namespace glint::materials

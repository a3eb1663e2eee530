// Reads the declarations of material features and effects: the JSON of
// shaders/materials/<feature>/<feature>.json and shaders/effects/<effect>/<effect>.json, whose members
// docs/schemas/material_feature.json and docs/schemas/effect.json describe.
#pragma once

#include "materials/declaration_files.h"
#include "materials/material_model.h"

#include <glint/result.h>

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::materials {

// Reads what each file says by itself, in the order of their names. Takes those of `known`, an earlier
// result, whose file has the same name and text. Error "declaration": a file is no JSON, or has unknown or
// missing members; the place is file#/json/pointer.
Result<ParsedDeclarations> parseDeclarations(std::span<const DeclarationFile> files,
                                             const ParsedDeclarations& known = {});

// Makes the model of all files together, as they may refer to each other. The result depends on neither the
// order of the files nor their folders. Error "declaration": that of parseDeclarations(), or a file uses a
// name twice, refers to one that does not exist, or has an expression that can't be read.
Result<MaterialModel> readDeclarations(ParsedDeclarations files);
Result<MaterialModel> readDeclarations(std::span<const DeclarationFile> files);

// --- Packs: material features of a user's own, beside those that Glint has ---

// Returns the files of the packs in `folders`: each folder's own declarations (.json) and GLSL (.glsl), and
// those of the folders in it, sorted by name. Error "materials-folder" if one can't be listed or has no
// declaration.
Result<std::vector<std::filesystem::path>> packFiles(std::span<const std::string> folders);

// Returns the model of Glint's own features together with those of the packs. It lives as long as the
// program, as materials refer to it. Without folders it is builtinMaterialModel(). What the last call has
// read is not parsed again as long as the files have the same text. Has the errors of packFiles(), readFile()
// and readDeclarations(), and "materials-glsl" if a file that a declaration names is not there, or reads a
// texture without asking whether the key has it, or a value that records of its model lack.
Result<const MaterialModel*> loadMaterialModel(std::span<const std::string> folders);

// Returns the same model with the present contents of some of its files of GLSL, which MaterialModel::files
// has. It lives as long as the program. Errors: those of readFile(), and "materials-glsl".
Result<const MaterialModel*> withPresentGlsl(const MaterialModel& model, std::span<const std::string> paths);

}  // namespace glint::materials

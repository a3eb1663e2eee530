// The text of declarations: those that are compiled into the library, and those of packs.
#pragma once

#include "base/files.h"

#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace glint::materials {

struct DeclarationFile {
    std::string_view name;  // for diagnostics: "materials/sheen/sheen.json"
    std::string_view text;
    bool isOfPack = false;  // of a user's own; its features and effects have bits after those of Glint's own
};

struct ParsedDeclaration;
// Declarations that several models have.
using ParsedDeclarations = std::vector<std::shared_ptr<const ParsedDeclaration>>;

// Returns the declarations of shaders/materials and shaders/effects ("materials/sheen/sheen.json"). They have
// static storage.
std::span<const base::BuiltinFile> declarationFiles();

}  // namespace glint::materials

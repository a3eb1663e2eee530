// The text of declarations: those that are compiled into the library, and those of packs.
#pragma once

#include "base/builtin_file.h"

#include <span>
#include <string_view>

namespace glint::materials {

struct DeclarationFile {
    std::string_view name;  // for diagnostics: "materials/sheen/sheen.json"
    std::string_view text;
    bool isOfPack = false;  // of a user's own; its features and effects have bits after those of Glint's own
};

// Returns the declarations of shaders/materials and shaders/effects ("materials/sheen/sheen.json"). They have
// static storage.
std::span<const base::BuiltinFile> declarationFiles();

}  // namespace glint::materials

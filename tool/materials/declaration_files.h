// The declarations that are compiled into the library.
#pragma once

#include "base/builtin_file.h"

#include <span>

namespace glint::materials {

// Returns the declarations of shaders/materials and shaders/effects ("materials/sheen/sheen.json"). They have
// static storage.
std::span<const base::BuiltinFile> declarationFiles();

}  // namespace glint::materials

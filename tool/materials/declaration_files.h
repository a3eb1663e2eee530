// The declarations that are compiled into the library.
#pragma once

#include "base/builtin_file.h"

#include <span>

namespace glint {

// Returns the declarations of shaders/materials and shaders/effects ("materials/sheen/sheen.json"). They have
// static storage.
std::span<const BuiltinFile> declarationFiles();

}  // namespace glint

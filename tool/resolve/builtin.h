// The shaders and templates that are compiled into the tool, so that an installed tool needs no data files.
#pragma once

#include "base/builtin_file.h"

#include <span>

namespace glint::compiler {

// Returns the files of shaders/, then those of templates/, each sorted by name. They have static storage.
std::span<const base::BuiltinFile> builtinFiles();

}  // namespace glint::compiler

// The sources of the page (tool/measure/page/), which are compiled into the tool.
#pragma once

#include "emit/builtin.h"

namespace glint {

// Returns the files, sorted by name. They have static storage.
std::span<const BuiltinFile> pageFiles();

}  // namespace glint

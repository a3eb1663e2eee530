// The sources of the page, which are compiled into the tool: tool/bench/page/.
#pragma once

#include "emit/builtin.h"

namespace glint {

// Sorted by name. Static storage.
std::span<const BuiltinFile> pageFiles();

}  // namespace glint

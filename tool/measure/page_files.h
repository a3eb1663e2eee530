// The sources of the page (tool/measure/page/), which are compiled into the tool.
#pragma once

#include "resolve/host.h"

namespace glint::measure {

// Returns the files, sorted by name. They have static storage.
std::span<const base::BuiltinFile> pageFiles();

}  // namespace glint::measure

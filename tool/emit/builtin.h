// The shaders and templates that are compiled into the tool, so that an installed one needs no data files.
#pragma once

#include <span>
#include <string_view>

namespace glint {

struct BuiltinFile {
    std::string_view name;  // below shaders/ or templates/: "interop/scene.h", "uber.comp.mustache"
    std::string_view text;
};

// Sorted by name within shaders/, then within templates/. Static storage.
std::span<const BuiltinFile> builtinFiles();

}  // namespace glint

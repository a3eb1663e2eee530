// The shaders and templates that are compiled into the tool, so that an installed tool needs no data files.
#pragma once

#include <span>
#include <string_view>

namespace glint {

struct BuiltinFile {
    std::string_view name;  // relative to shaders/ or templates/: "interop/scene.h", "uber.comp.mustache"
    std::string_view text;
};

// Returns the files of shaders/, then those of templates/, each sorted by name. They have static storage.
std::span<const BuiltinFile> builtinFiles();

}  // namespace glint

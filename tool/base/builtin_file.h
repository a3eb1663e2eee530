// A text file that is compiled into a library (cmake/GlintEmbed.cmake).
#pragma once

#include <string_view>

namespace glint::base {

struct BuiltinFile {
    std::string_view
        name;  // relative to the folder that was embedded: "interop/scene.h", "uber.comp.mustache"
    std::string_view text;
};

}  // namespace glint::base

// A small compute shader as the module of a case.
#pragma once

#include "emit/compile_modules.h"

#include <cstdint>
#include <string>

namespace glint::testing {

// `body` is the body of main(); it can use the buffer data.x.
inline ModuleSource makeTinyModule(int shaderId, const std::string& body) {
    return {{package::ModuleRole::ShadeCase, static_cast<std::uint32_t>(shaderId), 0},
            ShaderStage::Compute,
            "shade_" + std::to_string(shaderId) + ".comp",
            "#version 460\n#extension GL_GOOGLE_cpp_style_line_directive : require\n#line 10 \"case.glsl\"\n"
            "layout(local_size_x = 1) in;\nlayout(set = 0, binding = 0) buffer Data { uint x; } data;\n"
            "void main() {\n" +
                body + "\n}\n"};
}

}  // namespace glint::testing

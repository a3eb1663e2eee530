// A small compute shader as the module of a case.
#pragma once

#include "emit/glsl/text.h"
#include "emit/modules.h"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace glint::testing {

// Returns a unit whose lines have consecutive numbers in one file.
inline compiler::GlslUnit makeUnit(std::string_view text, std::string_view file, int firstNumber = 1) {
    compiler::GlslUnit unit;
    for (const std::string_view line : compiler::splitLines(text)) {
        unit.add(line, file, firstNumber++);
    }
    return unit;
}

// `body` is the body of main(); it can use the buffer data.x. The text after #version begins in line 10.
inline compiler::ModuleSource makeTinyModule(int shaderId, const std::string& body) {
    return {{package::roleNamed("ShadeCase"), static_cast<std::uint32_t>(shaderId), 0},
            compiler::ShaderStage::Compute,
            "shade_" + std::to_string(shaderId) + ".comp",
            std::make_shared<const compiler::ModuleGlsl>(makeUnit(
                "#version 460\n"
                "layout(local_size_x = 1) in;\nlayout(set = 0, binding = 0) buffer Data { uint x; } data;\n"
                "void main() {\n" +
                    body + "\n}\n",
                "case.glsl", 9))};
}

}  // namespace glint::testing

// A module as a self-contained text that holds everything that decides about its words, so that it can be
// compiled anywhere.
#pragma once

#include "emit/module_source.h"
#include "spirv/compiler.h"

#include <glint/result.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// Returns the GLSL below comments that hold the other inputs: the stage, the functions that are kept apart or
// linked, the names of the texts of its parts, and its own name if names are kept. Two modules have equal
// texts exactly if they are compiled alike. Without debug information the GLSL is that of essentialText().
std::string makeModuleText(const ModuleSource& source, bool debugInfo);

struct ModuleText {
    ShaderSource source;
    ShaderCompileOptions options;
    std::optional<LinkNames> link;   // of a part
    std::vector<std::string> parts;  // names of the texts whose modules are joined; empty: it is compiled
};
// Parses the text that makeModuleText() made. `name` is used in messages if the text has no name. Error
// "module-format".
Result<ModuleText> readModuleText(std::string_view text, const std::string& name);

// Returns a name for the text of a module: a 128-bit hash in hexadecimal digits.
std::string nameOfModuleText(std::string_view text);
inline constexpr std::size_t kModuleNameLength = 32;

}  // namespace glint::compiler

// A module as a self-contained text that holds everything that decides about its words, so that it can be
// compiled anywhere.
#pragma once

#include "emit/modules.h"
#include "spirv/compiler.h"

#include <glint/result.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// Returns the GLSL below comments that hold the other inputs: the stage, the functions that are kept apart,
// and the name if names are kept. Two modules have equal texts exactly if they are compiled alike. Without
// debug information the GLSL is that of essentialText().
std::string makeModuleText(const ModuleSource& source, bool debugInfo);

struct ModuleText {
    ShaderSource source;
    ShaderCompileOptions options;
};
// Parses the text that makeModuleText() made. `name` is used in messages if the text has no name. Error
// "module-format".
Result<ModuleText> readModuleText(std::string_view text, const std::string& name);

// Returns a name for each of `texts`, which must be distinct: the text's hash in hexadecimal digits, and a
// number if several texts have that hash.
std::vector<std::string> nameModuleTexts(std::span<const std::string* const> texts);

}  // namespace glint::compiler

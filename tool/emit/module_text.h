// A module as a text of its own: all that decides about its words, so that it can be compiled anywhere.
#pragma once

#include "emit/modules.h"
#include "spirv/compiler.h"

#include <glint/result.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// GLSL below comments that say what else decides: the stage, the functions that are kept apart, and the name
// where names are kept. Equal for two modules exactly where they are compiled alike: without debug
// information the GLSL is that of essentialText().
std::string makeModuleText(const ModuleSource& source, bool debugInfo);

struct ModuleText {
    ShaderSource source;
    ShaderCompileOptions options;
};
// Takes apart what makeModuleText() made. `name`: for messages, where the text has none. Error
// "module-format".
Result<ModuleText> readModuleText(std::string_view text, const std::string& name);

// A name for each of `texts`, which are distinct: the hash of the text in hexadecimal digits, and a number
// where several have that hash.
std::vector<std::string> nameModuleTexts(std::span<const std::string* const> texts);

}  // namespace glint

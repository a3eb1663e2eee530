// Modules that are compiled one by one, by other processes or on other machines: a file each before and
// after.
#pragma once

#include "cache/module_cache.h"
#include "emit/compile.h"
#include "emit/modules.h"

#include <glint/result.h>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

inline constexpr std::string_view kModuleTextSuffix = ".glsl";
inline constexpr std::string_view kCompiledModuleSuffix = ".module";

// Equal texts once, in the order of the modules; named by nameModuleTexts().
std::vector<PlannedModule> planModules(std::span<const ModuleSource> sources, bool debugInfo);

// What `glint compile-module` does: reads `input`, a module's text, and writes `output`; touches nothing
// else. Errors of readFile(), readModuleText(), compileShader() and writeFile().
Status compileModuleFile(const std::filesystem::path& input, const std::filesystem::path& output);

// Reads the compiled `file` of a folder for `text`. `name`: the module, for messages. Errors:
// "module-missing"; "module-stale" where it is of another text or another compiler; "module-format" where it
// is damaged.
Result<CachedModule> readCompiledModule(const std::filesystem::path& file, std::string_view text,
                                        const std::string& name);

}  // namespace glint

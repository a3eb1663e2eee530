// Modules that are compiled one by one, by other processes or on other machines, through a file before and a
// file after.
#pragma once

#include "cache/module_cache.h"
#include "emit/module_source.h"
#include "emit/package/compiled_package.h"

#include <glint/result.h>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

inline constexpr std::string_view kModuleTextSuffix = ".glsl";
inline constexpr std::string_view kCompiledModuleSuffix = ".module";

// Returns each distinct text once, in the order of the modules, those of parts before what is joined from
// them.
std::vector<PlannedModule> planModules(std::span<const ModuleSource> sources, bool debugInfo);

// Implements `glint compile-module`: reads a module's text from `input` and writes `output`. If the module is
// joined from parts, it reads their compiled files in the folder of `output`. It touches nothing else. Errors
// are those of readFile(), readModuleText(), compileMeasured(), joinMeasured(), readCompiledModule() and
// writeFile().
Status compileModuleFile(const std::filesystem::path& input, const std::filesystem::path& output);

// Reads the compiled `file` of a folder for `text`. `name` is the module's name, for messages. Errors:
// "module-missing"; "module-stale" if it was made from another text or by another compiler; "module-format"
// if it is damaged.
Result<CachedModule> readCompiledModule(const std::filesystem::path& file, std::string_view text,
                                        const std::string& name);

}  // namespace glint::compiler

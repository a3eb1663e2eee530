// Modules that are compiled one by one, also by other processes or on other machines: their text, and their
// compiled form.
#pragma once

#include "cache/module_cache.h"
#include "emit/package/compiled_package.h"
#include "emit/source_set.h"
#include "spirv/compiler.h"

#include <glint/result.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// Compiles a shader, or the part that `link` says, and measures it. Has the errors of compileShader() and
// compilePart().
Result<CachedModule> compileMeasured(const ShaderSource& source, const ShaderCompileOptions& options,
                                     const std::optional<LinkNames>& link = {});

// Joins compiled parts, the one with the entry point first, on at most `jobs` threads. If a part can't be
// joined, `source` is compiled as a whole.
Result<CachedModule> joinMeasured(const ShaderSource& source, const ShaderCompileOptions& options,
                                  std::span<const CachedModule* const> parts, int jobs = 1);

// Returns a text that differs between compilers that may give different words for the same source.
std::string moduleCompiler();

// A module as a self-contained text that holds everything that decides about its words, so that it can be
// compiled anywhere.

// Returns the GLSL below comments that hold the other inputs: the stage, the functions that are kept apart or
// linked, the names of the texts of its parts, whether it is optimised, and its own name if names are kept.
// Two modules have equal texts exactly if they are compiled alike. Without debug information the GLSL is that
// of essentialText(). The GLSL of the module and its parts must have been made.
std::string makeModuleText(const ModuleSource& source, const ShaderCompileOptions& options);
// Returns a hash that differs between texts of makeModuleText(), which it need not make. With debug
// information the GLSL must have been made.
TextHash hashOfModuleText(const ModuleSource& source, const ShaderCompileOptions& options);

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

// Modules that are compiled one by one, by other processes or on other machines, through a file before and a
// file after.

inline constexpr std::string_view kModuleTextSuffix = ".glsl";
inline constexpr std::string_view kCompiledModuleSuffix = ".module";

// Returns each distinct text once, in the order of the modules, those of parts before what is joined from
// them.
std::vector<PlannedModule> planModules(std::span<const ModuleSource> sources,
                                       const ShaderCompileOptions& options);

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

// --- Files for Make and Ninja: which files a run has read, and modules that are compiled one by one ---

// A dependency file in Make's syntax.
struct Depfile {
    std::string file;                  // empty: none
    std::vector<std::string> targets;  // at least one, where there is a file
};

// Returns "targets: dependencies", with each dependency once. Error "depfile-name" for a name that can't be
// written in a syntax that both Make and Ninja read: with a quote or one of &*;<>?^`| or a control character,
// a colon at the end, or a backslash at the end or before a space, '#' or ':'; a target with '=' or '%';
// dependencies that all contain a '='.
Result<std::string> makeDepfile(std::span<const std::string> targets,
                                std::span<const std::string> dependencies);

// Writes the file if its content changes. Does nothing if no file is named. Has the errors of makeDepfile(),
// and "file-write".
Status writeDepfile(const Depfile& depfile, std::span<const std::string> dependencies);

// The folder of a plan.
struct PlanFolder {
    std::string path;

    std::string buildFile() const;
    std::string modules() const;         // folder of the modules, before and after
    std::string planDepfile() const;     // what the plan was made of
    std::string packageDepfile() const;  // what making the package lists as read
};

// The compilation of a package by Ninja.
struct NinjaPlan {
    std::string tool;                  // path of glint
    std::string launcher;              // words of a shell before each compilation; may be empty
    PlanFolder folder;                 // of the build file and what Ninja keeps
    std::vector<std::string> outputs;  // of the package, at least one
    std::vector<std::string> plan;     // words after the tool's that make the plan again
    std::vector<std::string> package;  // words after the tool's that make the package of the modules
};

// Writes a text for each module of `package` and the build file into the plan's folder, but only files that
// changed, and removes the modules of an earlier plan. `dependencies` are the files that were read. Paths and
// words may contain any character except a line break, and paths no '|', which Ninja can't handle. Errors:
// "output-not-a-plan" if the folder has another build.ninja, "ninja-name", "depfile-name", "file-write".
Status writePlan(const NinjaPlan& plan, const PackagePlan& package,
                 std::span<const std::string> dependencies);

}  // namespace glint::compiler

// Compiles scenes to a package: plan, GLSL, SPIR-V, tables. It writes no files: see
// emit/package/compiled_package.h.
#pragma once

#include "emit/package/compiled_package.h"
#include "gltf/scene.h"
#include "gltf/scene_list.h"
#include "settings/settings.h"

#include <glint/result.h>

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace glint::compiler {

struct Build;
class ModuleCache;
class SourceSet;
class WarmModules;

// Plans a package. Has the errors of compilePackage(), except those of compiling.
Result<PackagePlan> planPackage(const Build& build);
Result<PackagePlan> planPackage(std::span<const gltf::Scene> scenes, const CompileSettings& settings);

// How a compilation after an edit shows it early, by makeEarlyPackage().
struct EarlyShowing {
    const CompiledPackage* before = nullptr;  // the last whole package
    // Gets the early package, if one can show the edit, before other modules are compiled. Returns whether it
    // is shown.
    std::function<bool(const CompiledPackage&)> publish;
    // Asked between two modules after publish() has returned true, by any thread. If it returns true, nobody
    // needs the whole package any more, and the compilation ends with the error "outdated".
    std::function<bool()> isOutdated;
};

// Compiles one package for the scenes of a build: they share the cases, and each has its own tables.
// Modules that `cache` has are not compiled; others are compiled and added to it. `warm` keeps modules in
// memory in the same way, and their GLSL. `showing` says how an edit is shown early. All may be null.
// Errors: too many cases ("max-shaders"); GLSL or SPIR-V that does not compile or validate, with file and
// line (a defect of Glint itself); with CompileSettings::modules, also those of takeModules().
Result<CompiledPackage> compilePackage(const Build& build, ModuleCache* cache = nullptr,
                                       WarmModules* warm = nullptr, const EarlyShowing* showing = nullptr);
// Resolves the settings for `scenes` (at least one) and compiles. Has the errors of both.
Result<CompiledPackage> compilePackage(std::span<const gltf::Scene> scenes, const CompileSettings& settings,
                                       ModuleCache* cache = nullptr);
inline Result<CompiledPackage> compilePackage(const gltf::Scene& scene, const CompileSettings& settings,
                                              ModuleCache* cache = nullptr) {
    return compilePackage(std::span(&scene, 1), settings, cache);
}

// --- Early packages: the package before an edit of a pack's GLSL, with one more module that shows the edit
// as a draft ---

class WarmModules;

// Returns the features that an early package can show the edit from `before` to `after` of: those of packs
// with GLSL that differs, at stages that a draft has (coordinates, surface, emission). Returns 0 if other
// GLSL differs, too. Declarations must not differ.
materials::FeatureMask editedFeatures(const materials::MaterialModel& before,
                                      const materials::MaterialModel& after);

// Makes the early package that shows how `plan` and `sources` differ from `before`, which is a whole package.
// Returns no value if no early package can show it: the package draws no frame, its tables differ, or
// editedFeatures() are none that a primitive has. Has the errors of makeEditSource() and compileModules().
Result<std::optional<CompiledPackage>> makeEarlyPackage(const gltf::SceneList& scenes, const Plan& plan,
                                                        const SourceSet& sources,
                                                        const CompileSettings& settings,
                                                        const CompiledPackage& before, WarmModules* warm);

// --- The library: shading as functions that other shaders include, without resources ---

// The folder of the library in a package.
inline constexpr std::string_view kLibraryFolder = "library/";

// Returns the library's files: glint_host.glsl, which declares what a shader that includes the library has to
// have; glint_library.glsl, which has all cases; with settings.emitLibrary a file for each case; and with
// settings.emitLinkable glint_library.spv, the same as glint_library.glsl for linkers. The settings' host,
// precision and answer do not matter. `cache`, which may be null, keeps compiled SPIR-V. Has the errors of
// makeSourceSet(), flatten() and compileLinkable().
Result<std::vector<PackageFile>> makeLibrary(const gltf::SceneList& scenes, const Plan& plan,
                                             const CompileSettings& settings,
                                             const ModuleCache* cache = nullptr);

}  // namespace glint::compiler

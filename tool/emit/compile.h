// Compiles scenes to a package: plan, GLSL, SPIR-V, tables. It writes no files: see
// emit/package/compiled_package.h.
#pragma once

#include "emit/package/compiled_package.h"
#include "gltf/scene.h"
#include "gltf/scene_list.h"
#include "settings/settings.h"

#include <glint/result.h>

#include <span>
#include <vector>

namespace glint::compiler {

struct Build;
class ModuleCache;
class WarmModules;

// Plans a package. Has the errors of compilePackage(), except those of compiling.
Result<PackagePlan> planPackage(const Build& build);
Result<PackagePlan> planPackage(std::span<const gltf::Scene> scenes, const CompileSettings& settings);

// Compiles one package for the scenes of a build: they share the cases, and each has its own tables.
// Modules that `cache` has are not compiled; others are compiled and added to it. `warm` keeps modules in
// memory in the same way, and their GLSL. Both may be null.
// Errors: too many cases ("max-shaders"); GLSL or SPIR-V that does not compile or validate, with file and
// line (a defect of Glint itself); with CompileSettings::modules, also those of takeModules().
Result<CompiledPackage> compilePackage(const Build& build, ModuleCache* cache = nullptr,
                                       WarmModules* warm = nullptr);
// Resolves the settings for `scenes` (at least one) and compiles. Has the errors of both.
Result<CompiledPackage> compilePackage(std::span<const gltf::Scene> scenes, const CompileSettings& settings,
                                       ModuleCache* cache = nullptr);
inline Result<CompiledPackage> compilePackage(const gltf::Scene& scene, const CompileSettings& settings,
                                              ModuleCache* cache = nullptr) {
    return compilePackage(std::span(&scene, 1), settings, cache);
}

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

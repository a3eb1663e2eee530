// The library: shading as functions that other shaders include, without resources.
#pragma once

#include "emit/package/compiled_package.h"
#include "gltf/scene_list.h"
#include "settings/settings.h"

#include <glint/result.h>

#include <vector>

namespace glint::compiler {

class ModuleCache;

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

// manifest.json describes the contents of a package for people and scripts (docs/package.md).
#pragma once

#include "emit/package/compiled_package.h"
#include "gltf/scene_list.h"
#include "settings/compile_settings.h"

#include <set>
#include <string>
#include <string_view>

namespace glint::compiler {

inline constexpr std::string_view kManifestFormat = "glint-package";

// Returns the text of the manifest. `package` must be complete except for the manifest itself.
std::string makeManifest(const gltf::SceneList& scenes, const CompiledPackage& package,
                         const CompileSettings& settings);

// Returns the names of the files that a manifest lists, itself included. Names that lead out of the folder
// are left out. Empty if `text` is not the manifest of a package.
std::set<std::string, std::less<>> manifestFiles(std::string_view text);

}  // namespace glint::compiler

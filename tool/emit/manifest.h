// manifest.json: what a package holds, for people and scripts. docs/package.md describes it.
#pragma once

#include "emit/compile.h"
#include "gltf/scene_list.h"

#include <set>
#include <string>
#include <string_view>

namespace glint {

inline constexpr std::string_view kManifestFormat = "glint-package";

// The text of the manifest; `package` must be complete but for the manifest itself.
std::string makeManifest(const SceneList& scenes, const CompiledPackage& package,
                         const CompileSettings& settings);

// Names of the files that a manifest lists, itself included, as far as they stay in its folder; empty if
// `text` is no manifest of a package.
std::set<std::string, std::less<>> manifestFiles(std::string_view text);

}  // namespace glint

// A package as C++ source, for programs that ship no files.
#pragma once

#include "base/staged_file.h"
#include "emit/compile.h"
#include "gltf/scene_list.h"

#include <filesystem>
#include <string>
#include <vector>

namespace glint {

struct EmbeddedSource {
    std::string header;  // declares glint::scene_x::embeddedPackage()
    std::string source;  // includes it as `headerName`
};

// The files that Package::load() reads, as arrays of 64-bit words.
EmbeddedSource makeEmbeddedSource(const SceneList& scenes, const CompiledPackage& package,
                                  const std::string& headerName);

// The header beside a source: "room_package.h" for "room_package.cpp".
std::filesystem::path embeddedHeader(const std::filesystem::path& source);

// Both, ready to be put in their place; those that killed runs left are removed, the folder is made. Error
// "output-write".
Result<std::vector<StagedFile>> stageEmbeddedSource(const SceneList& scenes, const CompiledPackage& package,
                                                    const std::filesystem::path& source);
// Writes both, each as a whole and only if it changed; makes the folder. Error "output-write".
Status writeEmbeddedSource(const SceneList& scenes, const CompiledPackage& package,
                           const std::filesystem::path& source);

}  // namespace glint

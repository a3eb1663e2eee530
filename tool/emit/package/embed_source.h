// A package as C++ source, for programs that ship without data files.
#pragma once

#include "base/files.h"
#include "emit/package/compiled_package.h"
#include "gltf/scene_list.h"

#include <filesystem>
#include <string>
#include <vector>

namespace glint::compiler {

struct EmbeddedSource {
    std::string header;  // declares glint::scene_x::embeddedPackage()
    std::string source;  // includes the header as `headerName`
};

// Returns the files that Package::load() reads, as arrays of 64-bit words.
EmbeddedSource makeEmbeddedSource(const gltf::SceneList& scenes, const CompiledPackage& package,
                                  const std::string& headerName);

// Returns the name of the header beside a source: "room_package.h" for "room_package.cpp".
std::filesystem::path embeddedHeader(const std::filesystem::path& source);

// Stages both files, ready to be moved to their place. It creates the folder and removes staged files that
// killed runs left behind. Error "output-write".
Result<std::vector<base::StagedFile>> stageEmbeddedSource(const gltf::SceneList& scenes,
                                                          const CompiledPackage& package,
                                                          const std::filesystem::path& source);
// Writes both files, each as a whole and only if it changed. It creates the folder. Error "output-write".
Status writeEmbeddedSource(const gltf::SceneList& scenes, const CompiledPackage& package,
                           const std::filesystem::path& source);

}  // namespace glint::compiler

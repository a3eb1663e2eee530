// Imports glTF 2.0 files as a Scene.
#pragma once

#include "gltf/import_options.h"
#include "gltf/planning_inputs.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <filesystem>

namespace glint::gltf {

// Reads `path` (.gltf or .glb), its buffers and its images. It refuses a URI that is absolute or leads above
// the scene's folder. On success, Scene::warnings lists everything that was skipped. The error is
// "scene-unknown" or "variant-unknown" if the file has no such scene or variant. Each error names the file
// and, if possible, the JSON pointer of the cause.
Result<Scene> importScene(const std::filesystem::path& path, const ImportOptions& options = {});

}  // namespace glint::gltf

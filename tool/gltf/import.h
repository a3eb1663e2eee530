// glTF 2.0 files into a Scene.
#pragma once

#include "gltf/scene.h"

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace glint {

struct ImportOptions {
    // Decode images. The compiler needs none of them; the renderer needs all.
    bool decodeImages = false;
    // Limits that keep hostile files from asking for the machine's memory.
    std::uint64_t maxVertices = 1ULL << 28;  // over all accessors
    std::uint64_t maxFileBytes = 1ULL << 32;
    int maxImageSize = 16384;  // pixels, either way
    // Refuses symbolic links that lead out of the scene's folder. Off, links are followed: build systems give
    // each action a folder of them. On, nothing outside of that folder is read: for scenes by strangers.
    bool strictPaths = false;
    // KHR_materials_variants: the name of the variant whose materials are used; empty: the default materials.
    std::string variant{};
};

// Reads `path` (.gltf or .glb), its buffers and its images. A URI that is absolute or leads above the scene's
// folder is refused.
// On success, Scene::warnings holds what was skipped. Error "variant-unknown" where the file lacks the
// variant. The error names the file and, where there is one, the JSON pointer of the culprit.
Result<Scene> importScene(const std::filesystem::path& path, const ImportOptions& options = {});

// The materials as planning sees them: those that animations change stand for all their values.
std::vector<Material> planningMaterials(const Scene& scene);

// The primitives of all meshes, mesh by mesh, as planning sees them.
std::vector<PrimitiveInputs> planningInputs(const Scene& scene);

}  // namespace glint

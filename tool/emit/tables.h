// tables.bin: the binary side of a package (runtime/include/glint/package_format.h).
#pragma once

#include "emit/compile.h"
#include "gltf/scene_list.h"

#include <interop/scene.h>
#include <span>
#include <vector>

namespace glint {

// Materials in the device's layout, and the textures that they refer to.
struct MaterialTables {
    std::vector<gpu::MaterialRecord> materials;
    std::vector<package::TextureEntry> textures;  // in order of first use
};

// Makes the material tables. Colour textures are sRGB, the others linear. Requires a scene that checkScene()
// accepts.
MaterialTables makeMaterialTables(const Scene& scene);

// The record of a material alone: its factors and the transforms of its textures. What it says of the
// textures themselves is for makeMaterialTables() to settle.
gpu::MaterialRecord makeMaterialRecord(const Material& material);

// Error "scene-index" where an index of `scene` leads nowhere; importScene() never makes such a scene.
Status checkScene(const Scene& scene);

// Returns the bytes of the file.
Bytes makeTables(const SceneList& scenes, const Plan& plan, std::span<const CompiledModule> modules,
                 const CompileSettings& settings);

}  // namespace glint

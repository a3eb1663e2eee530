// tables.bin: the binary side of a package (runtime/include/glint/internal/package_format.h).
#pragma once

#include "emit/material_layout.h"
#include "emit/package/compiled_package.h"
#include "gltf/scene_list.h"
#include "settings/settings.h"

#include <cstdint>
#include <span>
#include <vector>

namespace glint::compiler {

// Materials in the device's layout, and the textures that they refer to.
struct MaterialTables {
    std::vector<std::uint8_t> materials;          // records of the layout, one after the other
    std::vector<package::TextureEntry> textures;  // in order of first use
};

// Makes the material tables. Colour textures are sRGB, the others linear. Requires a scene that checkScene()
// accepts.
MaterialTables makeMaterialTables(const gltf::Scene& scene, const MaterialLayout& layout);

package::SamplerEntry samplerEntry(const gltf::Sampler& sampler);

// Returns the flags of a geometry with this material (kGeometry* of shaders/interop/scene.h), except whether
// its triangles are lights. `hitKey` is the key with the lobes that hits keep.
std::uint32_t geometryFlags(const materials::Material& material, const materials::PrimitiveInputs& inputs,
                            const materials::FeatureMask& hitKey, package::AlphaPolicy alpha,
                            package::ShadowThrough through);

// Error "scene-index" where an index of `scene` leads nowhere; importScene() never makes such a scene.
Status checkScene(const gltf::Scene& scene);

// Returns the bytes of the file.
base::Bytes makeTables(const gltf::SceneList& scenes, const Plan& plan,
                       std::span<const CompiledModule> modules, const CompileSettings& settings);

}  // namespace glint::compiler

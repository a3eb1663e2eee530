// Makes the arguments of SceneEditor (glint/scene.h) from a glTF material: a record, keys and textures.
#pragma once

#include "emit/material_layout.h"
#include "gltf/scene.h"

#include <glint/package.h>
#include <glint/scene.h>

#include <cstdint>
#include <span>
#include <vector>

namespace glint::session {

// The arrays behind a MaterialSource.
struct MaterialSourceData {
    std::vector<std::uint8_t> record;
    std::vector<SceneEditor::MaterialKey> keys;
    std::vector<SceneEditor::TextureUse> textures;

    SceneEditor::MaterialSource view() const {
        return {record, keys, textures};
    }
};

// A texture of glTF in a scene. The slot decides which of the two a material reads.
struct EditedTextures {
    TextureHandle color;  // in sRGB
    TextureHandle data;
};

// Returns the textures of a scene that was uploaded with the tables of `known`, by index into
// Scene::textures. Handles of textures that no material has name nothing.
std::vector<EditedTextures> uploadedTextures(const SceneEditor& editor, const PackageScene& known,
                                             const gltf::Scene& scene);

// Makes the source of a material whose textures are indices into Scene::textures of `scene`. `layout` is that
// of recordLayoutOf(). `textures` has a handle for each texture that the material has and the package reads;
// others are left out. Keys are made for `attributes`, which attributesOf() makes of primitives; if it is
// empty, for all sets of glTF's own attributes. `keptLobes` are those that hits keep (--hit-lobes).
MaterialSourceData makeMaterialSource(const Package& package, const compiler::MaterialLayout& layout,
                                      const gltf::Scene& scene, const materials::Material& material,
                                      std::span<const EditedTextures> textures,
                                      std::span<const AttributeMask> attributes = {},
                                      const materials::FeatureMask& keptLobes = materials::kAllFeatures);

}  // namespace glint::session

// Imports materials: core metallic-roughness, the extensions that Glint shades, and the choice between
// variants (KHR_materials_variants).
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

namespace glint::gltf {

// Fills materials, textures, samplers and images of the scene. Factors out of range are clamped with a
// warning.
Status importMaterials(Document& document, Scene& scene);

// Fills Scene::variants. Primitives get the materials of ImportOptions::variant if they have one for it. The
// error is "variant-unknown".
Status applyVariant(Document& document, Scene& scene);

}  // namespace glint::gltf

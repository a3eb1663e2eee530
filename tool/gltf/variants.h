// KHR_materials_variants: other materials for the same primitives.
#pragma once

#include "gltf/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

namespace glint::gltf {

// Fills Scene::variants, and gives the primitives the materials of ImportOptions::variant where they have one
// for it. Error "variant-unknown".
Status applyVariant(const Document& document, Scene& scene);

}  // namespace glint::gltf

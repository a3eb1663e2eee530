// Imports KHR_materials_variants, which gives other materials to the same primitives.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

namespace glint::gltf {

// Fills Scene::variants. Primitives get the materials of ImportOptions::variant if they have one for it. The
// error is "variant-unknown".
Status applyVariant(Document& document, Scene& scene);

}  // namespace glint::gltf

// Imports materials: core metallic-roughness and the extensions that Glint shades.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

namespace glint::gltf {

// Fills materials, textures, samplers and images of the scene. Factors out of range are clamped with a
// warning.
Status importMaterials(Document& document, Scene& scene);

}  // namespace glint::gltf

// The small textures that the cases read.
#pragma once

#include "gltf/scene.h"

namespace glint::synthetic {

// Indices into Scene::textures.
enum CaseTexture : int {
    kWhite,    // neutral as a factor
    kFlat,     // neutral as a normal map
    kColors,   // soft squares, for colours
    kFactors,  // every channel varies about 0.8, for factors
    kBumps,    // a normal map
};

// Adds the textures, their images and their sampler to a scene that has none.
void addTextures(gltf::Scene& scene);

}  // namespace glint::synthetic

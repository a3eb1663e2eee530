// What animations can make of a scene, at all times together: what planning decides by.
#pragma once

#include "gltf/scene.h"

namespace glint::gltf {

// Fills, once the animations are imported: AnimatedMaterial::generic, smoothest and changes, Node::canShow,
// Light::canShine, and the visibility at rest of nodes and lights.
void settleAnimatedValues(Scene& scene);

}  // namespace glint::gltf

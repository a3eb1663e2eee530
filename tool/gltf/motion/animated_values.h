// Finds the values that animations can give a scene over all times. Planning decides by them.
#pragma once

#include "gltf/scene.h"

namespace glint::gltf {

// Fills AnimatedMaterial::planned and changes, Node::canShow, Light::canShine, and the visibility
// of nodes and lights at rest. The animations must have been imported.
void settleAnimatedValues(Scene& scene);

}  // namespace glint::gltf

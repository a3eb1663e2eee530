// How many hits a primitive is expected to get, from its size in the world.
#pragma once

#include "gltf/scene.h"

namespace glint {

// Fills PrimitiveInputs::expectedHits: the sum of a / (a + 10 m) over the nodes that place the primitive's
// mesh, where a is its area there and m the median of all such areas. A small surface gets hits in proportion
// to its area, as a random line does (the Cauchy-Crofton formula); one that is large fills the view and gets
// no more. Of 35 thousand reflection rays that hit the gallery this puts 82 % in the right key (the shares'
// total variation is 0.18; 0.24 to 0.28 for factors of 1 and 100), the area alone, of which a ground plane
// has 99 %, 2 %, the number of triangles 32 %. Areas that are not finite count as 0. `inputs`: what
// planningInputs() makes, mesh by mesh.
void expectHits(const Scene& scene, std::vector<PrimitiveInputs>& inputs);

}  // namespace glint

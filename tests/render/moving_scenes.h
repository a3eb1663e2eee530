// Scenes whose nodes, skins and morph targets can be posed. All have a mirror below, that shows in
// reflections what the TLAS has, a camera and a sun.
#pragma once

#include "gltf/scene.h"

#include <vector>

namespace glint::testing {

// A place, turned about Z by `angle` radians.
Matrix4 placed(double x, double y, double z, double angle = 0.0);

// Two squares: the nodes 1 and 2.
Scene rigidScene();

// A strip, node 1, that follows two joints at its ends, nodes 2 and 3; the second is turned by `angle`
// radians.
Scene skinnedScene(double angle);

// A strip, node 1, with two morph targets.
Scene morphedScene(std::vector<double> weights);

// The same with vertices of node 1 that the host has moved.
Scene bakedScene(const Scene& scene);

}  // namespace glint::testing

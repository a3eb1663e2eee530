// Scenes whose nodes, skins and morph targets can be posed. All of them have a camera, a sun and a mirror
// below, whose reflections show the content of the TLAS.
#pragma once

#include "gltf/scene.h"

#include <vector>

namespace glint::testing {

// Returns a translation, turned about Z by `angle` radians.
gltf::Matrix4 placed(double x, double y, double z, double angle = 0.0);

// Returns two squares: the nodes 1 and 2.
gltf::Scene rigidScene();

// Returns a strip, node 1, that follows two joints at its ends, nodes 2 and 3. The second joint is turned by
// `angle` radians.
gltf::Scene skinnedScene(double angle);

// Returns a strip, node 1, with two morph targets.
gltf::Scene morphedScene(std::vector<double> weights);

// Returns the same scene with vertices of node 1 that the host has moved.
gltf::Scene bakedScene(const gltf::Scene& scene);

}  // namespace glint::testing

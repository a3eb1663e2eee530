// Returns a scene as messages and planning see it.
#pragma once

#include "gltf/scene.h"

#include <cstddef>
#include <string>
#include <vector>

namespace glint::gltf {

// Returns how messages name one of the file's scenes: `1 "Room"`, or `1` if it has no name.
std::string sceneLabel(const Scene& scene, std::size_t number);

// Returns the materials as planning sees them. A material that animations change stands for all its values.
std::vector<materials::Material> planningMaterials(const Scene& scene);

// The scene of a file that was read.
struct SceneInFile {
    int index = -1;      // -1: the file has no scenes
    std::string name{};  // empty: it has none
};
SceneInFile sceneInFile(const Scene& scene);

// Returns a primitive as planning sees it, without its expected hits.
materials::PrimitiveInputs inputsOf(const Scene& scene, std::size_t mesh, std::size_t index);

// Returns the primitives of all meshes as planning sees them, mesh by mesh.
std::vector<materials::PrimitiveInputs> planningInputs(const Scene& scene);

// Fills PrimitiveInputs::expectedHits with the sum of a / (a + 10 m) over the nodes that place the
// primitive's mesh. Here a is the primitive's area at that place, and m is the median of all such areas. A
// small surface gets hits in proportion to its area, as it would from random lines (the Cauchy-Crofton
// formula). A large surface fills the view and gets no more.
// 35 thousand reflection rays that hit the gallery were counted as a check. The formula puts 82 % of them in
// the right key (the total variation of the shares is 0.18; factors of 1 and 100 give 0.24 to 0.28). The area
// alone gives 2 %, because a ground plane has 99 % of it, and the number of triangles gives 32 %. Areas that
// are not finite count as 0. `inputs` comes from planningInputs(), mesh by mesh.
void expectHits(const Scene& scene, std::vector<materials::PrimitiveInputs>& inputs);

}  // namespace glint::gltf

// Imports skins and the influences of joints on vertices.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <string>
#include <vector>

namespace glint::gltf {

// The attributes JOINTS_n and WEIGHTS_n as stored, with four numbers for each vertex.
struct InfluenceSet {
    std::vector<Float4> joints;
    std::vector<Float4> weights;
};

// Joins the sets, drops influences that no vertex needs, and makes each vertex's weights sum to 1. The
// warning is "skin-weights" if they are off by more than rounding. `pointer` is that of the primitive.
SkinInfluences joinInfluences(Document& document, const std::string& pointer,
                              const std::vector<InfluenceSet>& sets);

// Fills scene.skins with the skins that nodes of the scene use, and fills Node::skin. Call it after importing
// nodes and meshes. A skin with a joint outside the scene is left out (warning "skin-joint-outside"). Errors:
// "skin-joint-range", "skin-matrices", "skin-joints".
Status importSkins(Document& document, Scene& scene);

}  // namespace glint::gltf

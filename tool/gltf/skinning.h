// Skins, and which vertices follow them.
#pragma once

#include "gltf/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <string>
#include <vector>

namespace glint::gltf {

// Attributes JOINTS_n and WEIGHTS_n as stored, four numbers a vertex.
struct InfluenceSet {
    std::vector<Float4> joints;
    std::vector<Float4> weights;
};

// Joins the sets, drops influences that no vertex needs, and makes each vertex's weights sum to 1 (warning
// "skin-weights" where they are off by more than rounding). `pointer`: of the primitive.
SkinInfluences joinInfluences(Document& document, const std::string& pointer,
                              const std::vector<InfluenceSet>& sets);

// Fills scene.skins with those that nodes of the scene use, and Node::skin; after nodes and meshes. A skin
// with a joint outside of the scene is left out (warning "skin-joint-outside").
// Errors: "skin-joint-range", "skin-matrices", "skin-joints".
Status importSkins(Document& document, Scene& scene);

}  // namespace glint::gltf

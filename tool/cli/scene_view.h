// From the compiler's Scene to the runtime's SceneView.
#pragma once

#include "gltf/scene.h"

#include <glint/scene_view.h>

#include <vector>

namespace glint {

// The arrays behind a SceneView. Spans point into the Scene, which must outlive it and stay as it is.
struct SceneViewData {
    std::vector<PrimitiveView> primitives;  // sorted by (mesh, primitive)
    std::vector<InstanceView> instances;
    std::vector<ImageView> images;
    std::vector<LightView> lights;

    // Points into this object.
    std::uint32_t packageScene = 0;  // as in SceneView
    SceneView view() const;
};

// Every mesh that a node places, with the numbers of mesh and primitive that the Scene has. Primitives
// without a triangle are left out, and so are instances of meshes that have no other.
SceneViewData makeSceneView(const Scene& scene);

// Three rows of four of a column-major matrix.
std::array<float, 12> toRows(const Matrix4& matrix);

// A warm light from the upper left, behind the default camera, for scenes without a light: 3 lux, which is a
// few times the radiance of the default sky.
LightView sunLight();

}  // namespace glint

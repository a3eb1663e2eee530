// Makes the runtime's SceneView from the compiler's Scene.
#pragma once

#include "gltf/scene.h"

#include <glint/scene_view.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace glint {

// The arrays behind a SceneView. Spans point into the Scene, which must outlive it and must not change.
struct SceneViewData {
    std::vector<PrimitiveView> primitives;  // sorted by (mesh, primitive)
    std::vector<InstanceView> instances;
    std::vector<ImageView> images;
    std::vector<LightView> lights;

    std::uint32_t packageScene = 0;  // as in SceneView
    bool moves = false;              // likewise
    TraversalOrder traversalOrder = TraversalOrder::Auto;
    std::vector<MaterialView> materials;  // those that animations change
    // By instance: what places it.
    struct Source {
        std::size_t node = 0;       // index into Scene::nodes
        std::size_t placement = 0;  // index into its Instancing, if it has one
    };
    std::vector<Source> sources;
    // The data to which the spans of primitives, instances and materials point.
    std::vector<std::vector<std::uint8_t>> materialRecords;
    std::vector<std::vector<MorphTargetView>> targets;
    std::vector<std::vector<std::array<float, 12>>> joints;
    std::vector<std::vector<float>> weights;

    // Both point into this object.
    SceneView view() const;
    MotionView motion() const;

    SceneViewData() = default;
    // A copy's spans would point into the original.
    SceneViewData(const SceneViewData&) = delete;
    SceneViewData& operator=(const SceneViewData&) = delete;
    SceneViewData(SceneViewData&&) = default;
    SceneViewData& operator=(SceneViewData&&) = default;
    ~SceneViewData() = default;
};

// Every mesh that a node places, with the numbers of mesh and primitive that the Scene has. Primitives
// without a triangle are left out, and so are instances of meshes that have no other, and nodes that are
// never shown.
SceneViewData makeSceneView(const Scene& scene);

// Takes the pose of `scene`, from which `data` was made: instances, joints, weights, materials and lights.
// Lights that were added after those of the scene stay.
void poseSceneView(const Scene& scene, SceneViewData& data);

// Returns three rows of four of a column-major matrix.
std::array<float, 12> toRows(const Matrix4& matrix);

// Returns a light for scenes without one: warm, from the upper left behind the default camera, 3 lux, which
// is a few times the radiance of the default sky.
LightView sunLight();

}  // namespace glint

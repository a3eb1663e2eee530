// Makes the runtime's view of a scene (glint/scene_view.h) from a Scene that was read from glTF. A program
// that uses both needs no other code between them:
//
//     Result<Scene> scene = importScene("room.gltf", {.decodeImages = true});
//     session::SceneViewData data = session::makeSceneView(*scene);
//     GpuScene::upload(context, package, data.view());
#pragma once

#include "emit/material_layout.h"
#include "gltf/scene.h"

#include <glint/package.h>
#include <glint/scene_view.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace glint::session {

struct TextureSet;  // glint/session/textures.h

// An axis-aligned box. It is empty if any min is above its max.
struct Bounds {
    std::array<double, 3> min{};
    std::array<double, 3> max{};
    bool empty() const;
};

// The arrays behind a SceneView. Spans point into the Scene, which must outlive it and must not change.
struct SceneViewData {
    // Sorted by (mesh, primitive), mesh by mesh from those that extendSceneView() has added last.
    std::vector<PrimitiveView> primitives;
    std::vector<InstanceView> instances;
    std::vector<ImageView> images;
    std::vector<LightView> lights;

    std::uint32_t packageScene = 0;    // as in SceneView
    bool moves = false;                // as in SceneView
    bool editable = false;             // as in SceneView
    bool sealed = false;               // the same
    std::uint32_t textureRoom = 1024;  // as in SceneView
    SceneView::TraversalOrder traversalOrder = SceneView::TraversalOrder::Auto;
    SceneView::OpacityUse opacity = SceneView::OpacityUse::Proved;
    SceneView::VertexForm vertices = SceneView::VertexForm::Compact;
    std::vector<MaterialView> materials;  // those that animations change
    // The sizes of the scene's lights, as LightView::size.
    float directionalSize = 0.0F;
    float placedSize = 0.0F;
    // The origin to which places are relative. A file has them in single precision for vertices and in double
    // precision for nodes. They are added in double precision and then rebased: places of vertices by mesh,
    // places in the world by pose. Both origins are 0 where everything is close enough to 0. poseSceneView()
    // is the border; cameras and bounds stay in the world.
    std::array<double, 3> origin{};                    // SceneView::origin, in the world
    std::vector<std::array<double, 3>> meshOrigins;    // by mesh number, in the mesh's space in the file
    std::vector<std::vector<gltf::Float3>> positions;  // of primitives whose mesh has an origin
    std::vector<Bounds> meshBoxes;                     // by mesh number, in the mesh's space in the file
    bool keepsOrigin = false;                          // poses leave the origin as it is
    std::vector<bool> listed;                          // by mesh number: its primitives are there
    // The light of Scene::lights that each light is, or -1.
    std::vector<int> lightSources;
    // The node that places each instance.
    struct Source {
        std::size_t node = 0;       // index into Scene::nodes
        std::size_t placement = 0;  // index into its Instancing, if it has one
    };
    std::vector<Source> sources;
    // Hold the images that useTextures() and addTextures() have given.
    std::vector<std::shared_ptr<const TextureSet>> textures;
    // The data to which the spans of primitives, instances and materials point.
    compiler::MaterialLayout materialLayout;  // of the package's records; without fields until useLayoutOf()
    std::vector<std::vector<std::uint8_t>> materialRecords;
    std::vector<std::vector<PrimitiveView::Attribute>> attributes;
    std::vector<std::vector<PrimitiveView::MorphTarget>> targets;
    std::vector<std::vector<std::array<float, 12>>> joints;
    std::vector<std::vector<float>> weights;

    // The arguments of GpuScene::upload() and Renderer::recordMotion(). Both point into this object and into
    // the Scene.
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

// Returns every mesh that a node places, with the numbers of mesh and primitive that the Scene has.
// Primitives without a triangle are left out, and so are instances of meshes without any other primitive, and
// nodes that are never shown. Positions are in metres, lights in lux (directional) and candela (point and
// spot). Copies no pixels, and positions only of meshes that are far from their own origin: `scene` must
// outlive the result. Its images must have been decoded, or loadTextures() must read them, or the runtime
// refuses them.
SceneViewData makeSceneView(const gltf::Scene& scene);

// Adds what edits have added to `scene` since: primitives of meshes that are now placed, instances of nodes,
// and lights. Meshes that are copies of others share their primitives. What edits have removed stays, and
// poses hide it. Poses keep the origin from then on.
void extendSceneView(const gltf::Scene& scene, SceneViewData& data);

// Returns the layout of the package's material records. `model` is that of the materials which it was
// compiled from.
compiler::MaterialLayout recordLayoutOf(const Package& package, const materials::MaterialModel& model);

// Makes records of materials in the layout of `package`, whose scene `scene` is. A scene with materials that
// animations change needs this before it is uploaded.
void useLayoutOf(const Package& package, const gltf::Scene& scene, SceneViewData& data);

// Takes the pose of `scene`, from which `data` was made: its origin, instances, joints, weights, materials
// and lights, which get the sizes of `data`. Lights that were added after the scene's own stay; they must be
// directional.
void poseSceneView(const gltf::Scene& scene, SceneViewData& data);

// Returns three rows of four of a column-major matrix.
std::array<float, 12> toRows(const gltf::Matrix4& matrix);

// Returns a light for scenes without one: warm, from the upper left behind the default camera, 3 lux, which
// is a few times the radiance of the default sky.
LightView sunLight();

// --- Poses: the place of every node, the weight of every morph target, and the values of materials, lights
// and cameras at a time of the animations. Times are seconds, transforms are column-major and in metres. None
// of these functions fails. ---

struct Pose {
    std::vector<gltf::Matrix4> worlds;  // one for each of Scene::nodes, in their order
    // For each node, the weights of its morph targets; empty if it has none.
    std::vector<std::vector<double>> weights;
    std::vector<bool> visible;                   // for each node, its own KHR_node_visibility
    std::vector<materials::Material> materials;  // one for each of Scene::animatedMaterials, in their order
    // These are empty if the scene has no restLights or restCameras. The nodes give their places.
    std::vector<gltf::Light> lights;
    std::vector<gltf::Camera> cameras;
};

// Returns the pose in which the file places everything.
Pose restPose(const gltf::Scene& scene);

// Returns the pose at `time`, in seconds from the start of the animations. `animations` holds indices into
// scene.animations. If two animations move the same property, the later one wins. Properties that none of
// them moves are at rest. Before an animation's first keyframe its properties have the values of the first,
// and after the last those of the last. Nothing repeats.
Pose poseAt(const gltf::Scene& scene, std::span<const std::size_t> animations, double time);

// Moves the nodes, cameras and lights of the scene to their places in the pose, and copies the weights into
// its nodes. If a node is squashed to nothing, its camera or light keeps its direction.
void applyPose(const Pose& pose, gltf::Scene& scene);

// A moment of a scene's animations.
struct Moment {
    std::vector<std::size_t> animations;  // indices into Scene::animations
    double seconds = 0.0;

    friend bool operator==(const Moment&, const Moment&) = default;
};

// Takes the scene to a moment, or to its rest pose.
void moveTo(const std::optional<Moment>& moment, gltf::Scene& scene);

// Returns a matrix for each joint of a skin, from the mesh's space to the world (glTF 2.0, section 3.7.3.3).
std::vector<gltf::Matrix4> jointMatrices(const gltf::Scene& scene, const gltf::Skin& skin);

// Returns the positions of a primitive in double precision. The differences of the targets are added,
// multiplied by `weights`: one for each target, and 0 for missing ones. The joints then transform the sum if
// the primitive follows any and `joints` is not empty (glTF 2.0, sections 3.7.2.2 and 3.7.3.3).
std::vector<std::array<double, 3>> deformedPositions(const gltf::Primitive& primitive,
                                                     std::span<const double> weights,
                                                     std::span<const gltf::Matrix4> joints);

}  // namespace glint::session

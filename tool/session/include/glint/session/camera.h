// Chooses the camera of a picture. Boxes and places are in metres and in world space.
#pragma once

#include "gltf/scene.h"

#include <glint/result.h>
#include <glint/scene_view.h>
#include <glint/session/scene_view.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace glint::session {

// Returns the union of the transformed boxes of all instances in the world, which may be larger than the
// geometry. Instances whose box is not finite are left out.
Bounds worldBounds(const SceneViewData& scene);

// Returns the same union at the pose of `scene`, from which `view` was made. For meshes that follow joints or
// morph targets it uses the deformed vertices.
Bounds posedBounds(const gltf::Scene& scene, const SceneViewData& view);

// Returns the union. An empty box adds nothing.
Bounds united(const Bounds& a, const Bounds& b);

// Fills the image with `bounds`, with a margin of 5 %, from the front (+Z), a little above and to the right.
// Flat objects are shown nearly head-on. The vertical field of view is 30°. An empty box, or a point, is
// treated as a box of 1 m around it. aspect is width / height.
CameraView framingCamera(const Bounds& bounds, double aspect);

// Returns camera `index` of the scene, which must have it. Its vertical field of view or height stays, and
// its width follows `aspect`. Error "camera-matrix" if its node's transform is singular.
Result<CameraView> sceneCamera(const gltf::Scene& scene, std::size_t index, double aspect);

// A camera that a user places: "1.5,2,3/0,0.5,0/30" is at (1.5, 2, 3), looks at (0, 0.5, 0) and has a
// vertical field of view of 30°. Up in the image is +Y. The two points must differ, not only in y.
struct PlacedCamera {
    std::array<double, 3> position{0.0, 0.0, 1.0};  // metres
    std::array<double, 3> target{};                 // metres
    double degrees = 30.0;                          // above 0, below 180
};

// Returns no value for other text. The field of view may be left out.
std::optional<PlacedCamera> parsePlacedCamera(std::string_view text);
// Returns a text from which parsePlacedCamera() returns the same camera.
std::string toText(const PlacedCamera& camera);
// The near plane is at a thousandth of the target's distance, and there is no far plane.
CameraView viewOf(const PlacedCamera& camera, double aspect);

struct CameraChoice {
    CameraView view;
    std::string name;  // for people: "auto", the camera's name or number, or a placed camera's text
};

// Returns whether chooseCamera() frames everything instead of taking a camera of the scene.
bool framesEverything(const gltf::Scene& scene, const std::string& wanted);

// `wanted` is "auto", a PlacedCamera, or the number or name of a camera of the scene. If it is empty, the
// first camera is used, or "auto" if there is none. Error "camera-unknown".
Result<CameraChoice> chooseCamera(const gltf::Scene& scene, const SceneViewData& view,
                                  const std::string& wanted, double aspect);
// Does the same with the bounds that an automatic camera frames.
Result<CameraChoice> chooseCameraAround(const gltf::Scene& scene, const Bounds& framed,
                                        const std::string& wanted, double aspect);

// Returns the warning "nothing-seen" if no triangle can be in a picture of this camera at the pose of
// `scene`: all are outside of the frustum, hidden, without an area, or one-sided and turned away. It stops at
// the first triangle that may be seen. `isCertain`: the picture has no surface, and the warning looks for the
// reasons. Returns nothing for a scene without instances; importScene() warns of it.
std::optional<Diagnostic> nothingSeen(const gltf::Scene& scene, const SceneViewData& view,
                                      const CameraChoice& camera, bool isCertain = false);

}  // namespace glint::session

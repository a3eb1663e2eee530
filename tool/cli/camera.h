// Where a picture is taken from.
#pragma once

#include "cli/bounds.h"
#include "cli/scene_view.h"
#include "gltf/scene.h"

#include <glint/result.h>
#include <glint/scene_view.h>

#include <array>
#include <string>

namespace glint {

// Of the transformed boxes of all instances: at most as tight as the geometry. Instances whose box is not
// finite are left out.
Bounds worldBounds(const SceneViewData& scene);

// The same at the pose of `scene`, from which `view` was made: of meshes that follow joints or morph targets
// the vertices as they are.
Bounds posedBounds(const Scene& scene, const SceneViewData& view);

// Both; an empty one adds nothing.
Bounds united(const Bounds& a, const Bounds& b);

// Fills the image with `bounds` but for a margin of 5 %, from the front (+Z), a little above and to the
// right; what is flat it shows nearly head-on. The vertical field of view is 30°. An empty box, or a point,
// is taken as one of 1 m around it. aspect is width / height.
CameraView framingCamera(const Bounds& bounds, double aspect);

// A camera of the scene: its vertical field of view or height stays, its width follows `aspect`.
// Error "camera-matrix" where its node squashes it flat.
Result<CameraView> sceneCamera(const Scene& scene, std::size_t index, double aspect);

struct CameraChoice {
    CameraView view;
    std::string name;  // for people: "auto", or the camera's name or number
};

// Whether chooseCamera() frames everything instead of taking a camera of the scene.
bool framesEverything(const Scene& scene, const std::string& wanted);

// `wanted`: "auto", the number or the name of a camera of the scene; empty: its first, else "auto".
// Error "camera-unknown".
Result<CameraChoice> chooseCamera(const Scene& scene, const SceneViewData& view, const std::string& wanted,
                                  double aspect);
// The same, with what an automatic camera is to frame.
Result<CameraChoice> chooseCameraAround(const Scene& scene, const Bounds& framed, const std::string& wanted,
                                        double aspect);

}  // namespace glint

// Imports the node hierarchy of one of the file's scenes, and the cameras and lights that it places.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

namespace glint::gltf {

// Chooses the scene by ImportOptions::scene, and fills its nodes, cameras and lights. Errors: "node-cycle",
// "node-parents" (a node with two parents), "node-transform", "camera-range", "scene-unknown".
Status importNodes(Document& document, Scene& scene);

// These import a camera or light of the file and place it. They are part of importNodes().
Result<Camera> importCamera(Document& document, int camera, const Matrix4& world);
Result<Light> importLight(Document& document, int light, const Matrix4& world);

}  // namespace glint::gltf

// The package that a scene on the device is drawn with, and its replacement by another one of the same scene.
#pragma once

#include "context/resources.h"
#include "data/geometry.h"
#include "data/retired.h"
#include "scene/gpu_scene_state.h"

#include <glint/package.h>
#include <glint/scene.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace glint {

// Returns the data that an upload has taken.
ScenePackage describePackage(const Package& package, const SceneView& scene);

// Returns the index of the scene in `package`. Errors: "scene-package" (it has no such scene, or differs in
// data that only an upload can change), "position-fetch", "half-precision".
Result<std::uint32_t> findScene(const GpuScene::State& scene, const Package& package);

// Returns the shader ID of each geometry record in `package`. Requires findScene().
std::vector<std::uint32_t> shaderIdsIn(const GpuScene::State& scene, const PackageScene& known);

// Records the copies that bring the scene's records of geometries and materials to `package`, which must run
// before all commands that read them, and makes `scene` one of that package. Values of materials that the
// host has given stay. Returns the resources that commands use which were recorded until then, or that these
// commands use. Requires findScene(), which gave `index`. With an error nothing changes. Errors: those
// of buffers.
Result<RetiredLot> recordReplacement(GpuScene::State& scene, const Package& package, std::uint32_t index,
                                     VkCommandBuffer commands);

}  // namespace glint

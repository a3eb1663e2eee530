// What a GpuScene has only if it moves: the pose on its way to the device, structures that are refitted, and
// the rules that say when.
#pragma once

#include "acceleration.h"
#include "deformer.h"
#include "geometry.h"
#include "motion_bounds.h"
#include "motion_rules.h"
#include "refit.h"
#include "timer.h"

#include <glint/renderer.h>

#include <memory>
#include <vector>

namespace glint {

// Members are destroyed in reverse: the pool's memory last.
struct SceneMotion {
    SceneMotion(Context::State& context, Timer stretches) : pool(context), timer(std::move(stretches)) {}

    MemoryPool pool;
    // Null where nothing changes its shape.
    std::unique_ptr<Deformer> deformer;
    std::unique_ptr<RefittedBlases> blases;    // of parts that an instance has for itself
    std::vector<std::uint32_t> blasInstances;  // by bottom level: the instance whose it is
    std::vector<BlasHistory> blasHistories;    // likewise

    std::vector<PartInstance> partInstances;                 // instances of the top level, in their order
    std::vector<VkAccelerationStructureInstanceKHR> placed;  // likewise, as last sent to the device
    Buffer placedBuffer;
    TlasBuild tlasBuild;
    Scratch tlasScratch;
    TlasHistory tlasHistory;

    // Of the scene's instances and lights, in their order.
    std::vector<std::uint32_t> meshes;
    std::vector<std::size_t> jointCounts;
    std::vector<std::size_t> weightCounts;
    std::vector<const MotionBounds*> bounds;  // into boundsOfMeshes
    std::vector<std::unique_ptr<MotionBounds>> boundsOfMeshes;
    std::vector<std::uint32_t> lightTypes;

    // Instance records, light records, `placed` and records of materials that change, one after the other,
    // for the copy to the device.
    Buffer staging;
    VkDeviceSize lightOffset = 0;
    VkDeviceSize placedOffset = 0;
    VkDeviceSize materialOffset = 0;

    Timer timer;  // deform, bottom levels, top level
    MotionStatistics statistics;
    bool recorded = false;
};

// Makes state.motion, and state.tlas from it, for a scene with SceneView::moves: bottom levels of `refitted`,
// which are those of the layout's parts that an instance has for itself, and the top level, built at the
// scene's pose; waits for the device. `deformer` is null where nothing changes its shape.
Status createMotion(GpuScene::State& state, const SceneView& scene, const SceneLayout& layout,
                    std::span<const BlasInput> refitted, std::unique_ptr<Deformer> deformer);

// GpuScene::update() and GpuScene::motion().
Status recordMotion(GpuScene::State& state, VkCommandBuffer commands, const MotionView& motion);
Result<MotionStatistics> readMotion(const GpuScene::State& state);

// An instance of the top level.
VkAccelerationStructureInstanceKHR makePlaced(bool doubleSided, const PartInstance& placed,
                                              const std::array<float, 12>& objectToWorld,
                                              VkDeviceAddress blas);

}  // namespace glint

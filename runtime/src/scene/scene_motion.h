// The part of a GpuScene that only moving scenes have: the staging memory for poses, structures that are
// refitted, and the rules for their builds.
#pragma once

#include "context/commands.h"
#include "data/acceleration.h"
#include "data/deformer.h"
#include "data/geometry.h"
#include "data/motion_bounds.h"
#include "scene/gpu_scene_state.h"

#include <glint/scene.h>

#include <memory>
#include <span>
#include <vector>

namespace glint {

class RefittedBlases {
public:
    // Creates structures and scratch, which are not built yet. The geometry of the inputs must stay in place.
    // `pool` must outlive the result.
    static Result<RefittedBlases> create(Context::State& context, MemoryPool& pool,
                                         std::span<const BlasInput> inputs);

    // Records the action for each structure; the first time, all are built. Batches share scratch: a batch
    // that does not fit beside the earlier ones waits for them. No dependency is recorded before the first
    // batch or after the last.
    void record(VkCommandBuffer commands, std::span<const BuildAction> actions) const;

    std::size_t size() const {
        return structures_.size();
    }
    VkDeviceAddress address(std::size_t index) const {
        return structures_[index].address;
    }
    VkDeviceSize bytes() const;
    void addMemory(std::vector<MemoryItem>& items) const;

private:
    explicit RefittedBlases(Context::State& context) : context_(&context) {}

    Context::State* context_;
    Scratch scratch_;
    VkDeviceSize scratchBytes_ = 0;
    std::vector<BlasBuild> builds_;
    std::vector<AccelerationStructure> structures_;
};

// Members are destroyed in reverse order: the pool's memory last.
struct SceneMotion {
    SceneMotion(Context::State& context, Timer stretches) : pool(context), timer(std::move(stretches)) {}

    MemoryPool pool;
    // Null if no instance changes its shape.
    std::unique_ptr<Deformer> deformer;
    std::unique_ptr<RefittedBlases> blases;    // BLASes of parts that belong to one instance
    std::vector<std::uint32_t> blasInstances;  // for each refitted BLAS, its instance
    std::vector<BlasHistory> blasHistories;    // for each refitted BLAS

    std::vector<PartInstance> partInstances;                 // instances of the TLAS, in their order
    std::vector<VkAccelerationStructureInstanceKHR> placed;  // the same, as last sent to the device
    Buffer placedBuffer;
    PreparedTlas tlas;
    Scratch tlasScratch;
    TlasHistory tlasHistory;

    // Properties of the scene's instances and lights, in their order.
    std::vector<std::uint32_t> meshes;
    std::vector<std::size_t> jointCounts;
    std::vector<std::size_t> weightCounts;
    std::vector<const MotionBounds*> bounds;  // point into boundsOfMeshes
    std::vector<std::unique_ptr<MotionBounds>> boundsOfMeshes;
    std::vector<std::uint32_t> lightTypes;

    // The source of the copy to the device: instance records, light records, nodes of their hierarchy,
    // records of emissive triangles if there is no hierarchy, `placed` and records of changing materials, one
    // after the other.
    Buffer staging;
    VkDeviceSize lightOffset = 0;
    VkDeviceSize lightNodeOffset = 0;
    VkDeviceSize emitterOffset = 0;
    VkDeviceSize placedOffset = 0;
    VkDeviceSize materialOffset = 0;

    Timer timer;  // deform, BLASes, TLAS
    MotionStatistics statistics;
    bool recorded = false;
};

// Makes state.motion and state.tlas for a scene with SceneView::moves. It queues the builds of the BLASes of
// `refitted`, which are the layout's parts that belong to one instance, and the TLAS at the scene's pose.
// `deformer` is null if no instance changes its shape.
Status createMotion(GpuScene::State& state, const SceneView& scene, const SceneLayout& layout,
                    std::span<const BlasInput> refitted, std::unique_ptr<Deformer> deformer,
                    Uploader& uploader);
// Adds the device times of these builds to the statistics, if they are complete and no update was recorded.
void readFirstBuild(GpuScene::State& state);

// These implement GpuScene::update() and GpuScene::motion().
Status recordMotion(GpuScene::State& state, VkCommandBuffer commands, const MotionView& motion);
Result<MotionStatistics> readMotion(const GpuScene::State& state);

}  // namespace glint

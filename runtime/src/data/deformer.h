// Skins and morphs meshes on the device. Each deformed instance has its vertices in buffers of its own.
#pragma once

#include "context/resources.h"
#include "context/upload.h"
#include "data/geometry.h"

#include <glint/package.h>
#include <glint/scene_view.h>

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

namespace glint {

// Returns whether joints or weights move the instance's vertices. Its mesh may also have primitives that do
// not move.
bool isDeformed(const InstanceView& instance);
bool hasDeformedInstance(const SceneView& scene);

// The buffers that receive the vertices of deformed primitives.
struct DeformedBuffers {
    std::vector<Buffer> buffers;
    DeformedAddresses addresses;
};

// Makes the layout of the pipeline that deforms. Error "vulkan-call".
Result<UniquePipelineLayout> createDeformLayout(Context::State& context);

class Deformer {
public:
    // Queues copies in `uploader`, which must finish before recordDeform(). Fills `target`. `target`,
    // `targetPool` and `primitives` must outlive the Deformer. The first pose is that of the scene's
    // instances. Error "scene-package": the package has no pass that deforms.
    static Result<std::unique_ptr<Deformer>> create(Context::State& context, const Package& package,
                                                    const SceneView& scene,
                                                    std::span<const GpuPrimitive> primitives,
                                                    Uploader& uploader, MemoryPool& targetPool,
                                                    DeformedBuffers& target);

    // Writes the instances' pose to memory that the host sees. Nothing of an earlier recordPose() may be in
    // flight. Returns for each instance of the scene whether its vertices move.
    std::vector<bool> setPose(std::span<const InstanceView> instances);
    // Records the copy of the pose to the device.
    void recordPose(VkCommandBuffer commands) const;
    // Records the pass for the instances that `moved` marks. The pose must be visible to compute shaders.
    void recordDeform(VkCommandBuffer commands, const std::vector<bool>& moved) const;

    // Adds the Deformer's own memory, without that of the target.
    void addMemory(std::vector<MemoryItem>& items) const;
    VkDeviceSize allocatedBytes() const {
        return pool_.bytes();
    }

private:
    explicit Deformer(Context::State& context) : context_(&context), pool_(context) {}

    // A primitive's morph differences and joint influences on the device.
    struct Source {
        Buffer buffer;
        VkDeviceAddress targetPositions = 0;
        VkDeviceAddress targetNormals = 0;
        VkDeviceAddress targetTangents = 0;
        VkDeviceAddress joints = 0;
        VkDeviceAddress jointWeights = 0;
        std::uint32_t influences = 0;  // influences of each vertex
    };
    // The place of an instance's joints and weights in the pose buffer.
    struct Slot {
        std::uint32_t instance = 0;
        VkDeviceSize joints = 0;  // offset in bytes
        VkDeviceSize weights = 0;
        std::size_t weightCount = 0;  // the largest number of targets among the mesh's primitives
    };
    struct Dispatch {
        std::uint32_t instance = 0;
        std::uint32_t vertexCount = 0;
    };

    Status createPipeline(const Package& package);
    Status createPoseBuffers(const SceneView& scene);
    Status createRecords(const SceneView& scene, std::span<const GpuPrimitive> primitives, Uploader& uploader,
                         MemoryPool& targetPool, DeformedBuffers& target);
    Result<Source> uploadSource(const PrimitiveView& view, Uploader& uploader);

    Context::State* context_;
    MemoryPool pool_;
    UniquePipelineLayout layout_;
    UniquePipeline pipeline_;
    std::map<std::uint32_t, Source> sources_;  // keyed by index into SceneView::primitives
    std::vector<Slot> slots_;                  // one for each deformed instance
    Buffer pose_;
    Buffer staging_;
    Buffer records_;
    std::vector<Dispatch> dispatches_;
};

}  // namespace glint

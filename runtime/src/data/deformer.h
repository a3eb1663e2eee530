// Skins and morphs meshes on the device. Each instance that changes its shape has vertices of its own.
#pragma once

#include "context/resources.h"
#include "context/upload.h"
#include "data/geometry.h"
#include "interop/deform.h"

#include <glint/package.h>
#include <glint/scene_view.h>

#include <cstdint>
#include <span>
#include <utility>

namespace glint {

// The morph differences and joint influences of a primitive on the device. A primitive that keeps its shape
// has no buffer.
struct DeformSource {
    Buffer buffer;
    VkDeviceAddress targetPositions = 0;
    VkDeviceAddress targetNormals = 0;
    VkDeviceAddress targetTangents = 0;
    VkDeviceAddress joints = 0;
    VkDeviceAddress jointWeights = 0;
    std::uint32_t influences = 0;  // of each vertex
    std::uint32_t targets = 0;
    std::uint32_t jointCount = 0;  // one more than the largest joint that a vertex follows

    // Returns whether a pose with joints, or with weights, moves the primitive's vertices.
    bool moves(bool hasJoints, bool hasWeights) const {
        return (hasJoints && influences > 0) || (hasWeights && targets > 0);
    }
};
// Queues the copies in `uploader`.
Result<DeformSource> uploadDeformSource(Context::State& context, MemoryPool& pool, Uploader& uploader,
                                        const PrimitiveView& view);

// The vertices of one primitive of one instance. The address of an attribute that it lacks is 0. A primitive
// that does not move has no buffer.
struct DeformedVertices {
    Buffer buffer;
    VkDeviceAddress positions = 0;
    VkDeviceAddress normals = 0;
    VkDeviceAddress tangents = 0;
};
Result<DeformedVertices> createDeformedVertices(Context::State& context, MemoryPool& pool,
                                                const GpuPrimitive& primitive);

// Makes the record of a pass over the vertices. `joints` and `weights` are where the pose is.
gpu::DeformRecord makeDeformRecord(const GpuPrimitive& primitive, const DeformSource& source,
                                   const DeformedVertices& vertices, VkDeviceAddress joints,
                                   VkDeviceAddress weights);

// Makes the layout of the pipeline that deforms. Error "vulkan-call".
Result<UniquePipelineLayout> createDeformLayout(Context::State& context);

class DeformPass {
public:
    // Error "scene-package": the package has no pass that deforms.
    static Result<DeformPass> create(Context::State& context, const Package& package);

    // Records the pass for records, given as their index and their number of vertices. The records, and the
    // poses, must be visible to compute shaders.
    void record(VkCommandBuffer commands, VkDeviceAddress records,
                std::span<const std::pair<std::uint32_t, std::uint32_t>> deformed) const;

private:
    explicit DeformPass(Context::State& context) : context_(&context) {}

    Context::State* context_;
    UniquePipelineLayout layout_;
    UniquePipeline pipeline_;
};

}  // namespace glint

// Compaction of bottom levels after the upload. They are built at their full size, and the size of a
// compacted copy is known when the device has built them.
#pragma once

#include "scene/acceleration.h"

#include <glint/scene_edit.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace glint {

// The place of a BLAS in a scene that is edited.
struct PartOfMesh {
    MeshHandle mesh;
    std::size_t primitive = 0;
    std::size_t part = 0;
};

struct Compaction {
    explicit Compaction(Context::State& context) : pool(context) {}

    // Of the structures as they were built, and of what the recording needs. Members are destroyed in reverse
    // order: the pool's memory last.
    MemoryPool pool;
    UniqueQueryPool sizes;  // of the compacted copies: one for each BLAS of the upload
    std::uint32_t count = 0;
    std::vector<AccelerationStructure> replaced;
    std::vector<Buffer> kept;
    // The top level of a scene that neither moves nor is edited, as it was built.
    std::vector<VkAccelerationStructureInstanceKHR> placed;
    std::vector<PartOfMesh> parts;       // in a scene that is edited
    bool queued = false;                 // the editor has the copies
    std::optional<std::uint64_t> frame;  // in which the copies were recorded
};

// These implement GpuScene::recordCompaction() and the part of GpuScene::complete() that is about it.
Result<bool> recordCompaction(GpuScene::State& state, VkCommandBuffer commands, std::uint64_t frame);
void completeCompaction(GpuScene::State& state, std::uint64_t frame);

}  // namespace glint

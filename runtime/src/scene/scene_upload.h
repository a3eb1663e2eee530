// The resources of a scene's upload that must stay until the device has completed it, and the compaction that
// follows.
#pragma once

#include "context/commands.h"
#include "context/upload.h"
#include "data/acceleration.h"
#include "data/opacity_micromap.h"

#include <glint/scene.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace glint {

// --- Compaction ---
// BLASes are built at their full size. The size of a compacted copy is known when the device has built them.

// The place of a BLAS: a part of a mesh, or of an instance with its own shape.
struct PartPlace {
    MeshHandle mesh;
    InstanceHandle instance;
    std::uint32_t part = 0;
};

struct Compaction {
    explicit Compaction(Context::State& context) : pool(context) {}

    // It holds the structures as they were built. Members are destroyed in reverse order: the pool's memory
    // last.
    MemoryPool pool;
    UniqueQueryPool sizes;  // of the compacted copies, in the order of `parts`
    std::vector<AccelerationStructure> replaced;
    std::vector<PartPlace> parts;
    bool queued = false;                 // the next recording makes the copies
    std::optional<std::uint64_t> frame;  // frame of the recorded copies
};

// Implements the part of GpuScene::complete() that is about compaction.
void completeCompaction(GpuScene::State& state, std::uint64_t frame);

// --- The upload ---

// Its pool holds scratch and the inputs of acceleration structures, too.
struct SceneUpload : StagedCopies {
    using StagedCopies::StagedCopies;

    // Keeps a buffer of `pool`, if there is one, until the upload is complete.
    void keep(Buffer&& buffer) {
        if (buffer.handle.get() != VK_NULL_HANDLE) {
            kept.push_back(std::move(buffer));
        }
    }

    std::unique_ptr<Compaction> compaction{};  // null if there is no BLAS to compact
};

// Returns the compaction that follows an upload, which it makes at the first call.
Compaction& compactionOf(SceneUpload& upload);
// Makes room for the sizes of the compacted copies, if there are any. Errors: those of Vulkan's calls.
Status prepareCompaction(SceneUpload& upload);
// Records the reading of these sizes. `structures` are those of Compaction::parts.
void recordCompactedSizes(const SceneUpload& upload, VkCommandBuffer commands,
                          std::span<const VkAccelerationStructureKHR> structures);

// --- Opacity micromaps ---

// Returns the highest level that the device takes, at most opacity::kMaxLevel; 0 without the extension.
std::uint32_t micromapLevel(const Context::State& context);

// Creates a micromap for each array, and queues their builds in the upload. Requires
// DeviceHandles::opacityMicromaps, and arrays within micromapLevel(). `pool` must outlive the result. Errors:
// those of memory and Vulkan's calls.
Result<std::vector<DeviceMicromap>> addMicromaps(SceneUpload& upload, MemoryPool& pool,
                                                 std::span<const opacity::MicromapArray> arrays);

}  // namespace glint

// The resources of a scene's upload that must stay until the device has completed it, and the compaction that
// follows.
#pragma once

#include "context/commands.h"
#include "context/upload.h"
#include "data/acceleration.h"
#include "data/deformer.h"
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

// The place of a BLAS in a scene that is edited.
struct PartOfMesh {
    MeshHandle mesh;
    std::size_t primitive = 0;
    std::size_t part = 0;
};

struct Compaction {
    explicit Compaction(Context::State& context) : pool(context) {}

    // It holds the structures as they were built, and what the recording needs. Members are destroyed in
    // reverse order: the pool's memory last.
    MemoryPool pool;
    UniqueQueryPool sizes;  // of the compacted copies: one for each BLAS of the upload
    std::uint32_t count = 0;
    std::vector<AccelerationStructure> replaced;
    std::vector<Buffer> kept;
    // The TLAS of a scene that neither moves nor is edited, as it was built.
    std::vector<VkAccelerationStructureInstanceKHR> placed;
    std::vector<PartOfMesh> parts;       // in a scene that is edited
    bool queued = false;                 // the editor has the copies
    std::optional<std::uint64_t> frame;  // frame of the recorded copies
};

// These implement GpuScene::recordCompaction() and the part of GpuScene::complete() that is about it.
Result<bool> recordCompaction(GpuScene::State& state, VkCommandBuffer commands, std::uint64_t frame);
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

    // The stretches that `timer` measures.
    static constexpr std::uint32_t kBlasStretch = 0;
    static constexpr std::uint32_t kTlasStretch = 1;

    std::unique_ptr<Deformer> deformer;  // of a scene that does not move and is not in its rest pose
    std::optional<Timer> timer;
    std::uint32_t stretches = 0;             // recorded ones
    std::unique_ptr<Compaction> compaction;  // null if there is no BLAS to compact
};

// --- Structures ---

struct BlasStatistics {
    std::uint64_t bytes = 0;  // before compaction
};
// Creates a BLAS for each input, and queues their builds in the upload. They are in the memory of the
// upload's Compaction, which is made here, and stay at their full size until it is recorded. Errors: those of
// memory and Vulkan's calls.
Result<std::vector<AccelerationStructure>> addBlases(SceneUpload& upload, std::span<const BlasInput> inputs,
                                                     BlasStatistics& statistics);

// Creates a TLAS in memory of `pool`, and queues its build in the upload. `instances` may be empty. Error
// "tlas-limit".
Result<AccelerationStructure> addTlas(SceneUpload& upload, MemoryPool& pool,
                                      std::span<const VkAccelerationStructureInstanceKHR> instances);

// Returns the highest level that the device takes, at most opacity::kMaxLevel; 0 without the extension.
std::uint32_t micromapLevel(const Context::State& context);

// Creates a micromap for each array, and queues their builds in the upload. Requires
// DeviceHandles::opacityMicromaps, and arrays within micromapLevel(). `pool` must outlive the result. Errors:
// those of memory and Vulkan's calls.
Result<std::vector<DeviceMicromap>> addMicromaps(SceneUpload& upload, MemoryPool& pool,
                                                 std::span<const opacity::MicromapArray> arrays);

}  // namespace glint

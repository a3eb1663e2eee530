// Functions that build acceleration structures.
#pragma once

#include "context/memory.h"
#include "context/resources.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Members are destroyed in reverse order: the structure before its buffer.
struct AccelerationStructure {
    Buffer buffer;
    UniqueAccelerationStructure handle;
    VkDeviceAddress address = 0;
};

struct DeviceMicromap;

// One geometry of a BLAS: a triangle list in device buffers.
struct BlasGeometry {
    VkDeviceAddress positions = 0;  // three floats each
    VkDeviceAddress indices = 0;
    std::uint32_t vertexCount = 0;
    std::uint32_t triangleCount = 0;  // must not be 0
    bool opaque = true;
    bool once = false;                         // a ray meets each triangle at most once, although it goes on
    bool shortIndices = false;                 // 16 bits each, else 32
    const DeviceMicromap* micromap = nullptr;  // must outlive the structure; null: none
};

// The largest content of one BLAS.
struct BlasCapacity {
    std::uint64_t triangles = 0;
    std::uint64_t geometries = 0;
};

struct BlasInput {
    std::vector<BlasGeometry> geometries;  // not empty; within blasCapacity()
    bool dataAccess = false;               // shaders read the positions of hit triangles from this BLAS
    bool updatable = false;                // built fast and refitted; not compacted
};

// Returns the largest content of one BLAS of this device. It follows from the device's limits; also, no
// structure and no scratch may exceed maxStorageBufferRange, because mobile drivers bind both as storage
// buffers.
BlasCapacity blasCapacity(const Context::State& context);

struct SceneUpload;

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

// A TLAS in Vulkan's terms. `instances` is the address of their array, or 0 to ask for sizes only. `info`
// points at `geometry`, so it must be set again after a move.
struct TlasBuild {
    VkAccelerationStructureGeometryKHR geometry{};
    VkAccelerationStructureBuildGeometryInfoKHR info{};
    VkAccelerationStructureBuildSizesInfoKHR sizes{};
};
// Fills `build`. Error "tlas-limit".
Status describeTlas(const Context::State& context, VkDeviceAddress instances, std::size_t count,
                    bool updatable, TlasBuild& build);

// Creates a structure of `bytes` that is not built yet, for BLASes and TLASes.
Result<AccelerationStructure> createStructure(Context::State& context, MemoryPool& pool, VkDeviceSize bytes,
                                              VkAccelerationStructureTypeKHR type);
// A scratch buffer. `address` has the alignment that the device asks for.
struct Scratch {
    Buffer buffer;
    VkDeviceAddress address = 0;
};
Result<Scratch> createScratch(Context::State& context, MemoryPool& pool, VkDeviceSize bytes);

// A build of a TLAS with memory of its own for its input and its scratch. `kept` gets both, from `pool`.
struct PreparedTlas {
    TlasBuild build;
    VkDeviceAddress scratch = 0;
    std::uint32_t count = 0;  // of instances
};
Result<PreparedTlas> prepareTlas(Context::State& context, MemoryPool& pool,
                                 std::span<const VkAccelerationStructureInstanceKHR> instances,
                                 bool updatable, std::vector<Buffer>& kept);
void recordTlasBuild(const Context::State& context, VkCommandBuffer commands, const PreparedTlas& prepared,
                     VkAccelerationStructureKHR target);

}  // namespace glint

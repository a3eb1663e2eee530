// Functions that build acceleration structures.
#pragma once

#include "context/commands.h"
#include "context/resources.h"

#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// Members are destroyed in reverse order: the structure before its buffer.
struct AccelerationStructure {
    Buffer buffer;
    UniqueAccelerationStructure handle;
    VkDeviceAddress address = 0;
};

// Members are destroyed in reverse order: the micromap before its buffer.
struct DeviceMicromap {
    Buffer buffer;
    UniqueMicromap handle;                   // null if no triangle has a record
    Buffer indices;                          // 32 bits for each triangle
    std::vector<VkMicromapUsageEXT> usages;  // of triangles, as a BLAS asks for them
    std::uint64_t bytes = 0;                 // on the device
};

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

// A TLAS in Vulkan's terms, without its instances.
struct TlasBuild {
    VkAccelerationStructureBuildGeometryInfoKHR info{};
    VkAccelerationStructureBuildSizesInfoKHR sizes{};
};
// Describes a TLAS of at most `count` instances. Error "tlas-limit".
Result<TlasBuild> describeTlas(const Context::State& context, std::size_t count, bool updatable);

// Creates a structure of `bytes` that is not built yet, for BLASes and TLASes.
Result<AccelerationStructure> createStructure(Context::State& context, MemoryPool& pool, VkDeviceSize bytes,
                                              VkAccelerationStructureTypeKHR type);
// Creates scratch memory with the alignment that the device asks for.
Result<AlignedBuffer> createScratch(Context::State& context, MemoryPool& pool, VkDeviceSize bytes);

// The input of a build of a TLAS: an array of VkAccelerationStructureInstanceKHR, and scratch memory.
struct TlasInput {
    VkDeviceAddress instances = 0;
    std::uint32_t count = 0;
    VkDeviceAddress scratch = 0;
};
// Records the build, or a refit of what was built in `target`.
void recordTlasBuild(const Context::State& context, VkCommandBuffer commands, const TlasBuild& build,
                     const TlasInput& input, VkAccelerationStructureKHR target, bool refit);

// An input in Vulkan's terms. `info` points into `geometries`, and these into `micromaps`. Both stay in place
// when a BlasBuild moves, since they are vectors.
struct BlasBuild {
    std::vector<VkAccelerationStructureGeometryKHR> geometries;
    std::vector<VkAccelerationStructureTrianglesOpacityMicromapEXT> micromaps;  // of some geometries
    std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
    VkAccelerationStructureBuildGeometryInfoKHR info{};
    VkDeviceSize structureBytes = 0;
    VkDeviceSize scratchBytes = 0;  // of a build or a refit, rounded up to the alignment of scratch
};

// Describes a build except for its destination and its scratch memory.
BlasBuild describeBuild(const Context::State& context, const BlasInput& input);

// Orders builds that share scratch memory, or of which one reads the result of the other.
inline constexpr MemoryDependency kBuildsInOrder{
    VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
    VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR,
    VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
    VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR | VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR};

struct ScratchRange {
    VkDeviceAddress address = 0;
    VkDeviceSize bytes = 0;
};

// A build with its destination, or a refit of what was built there.
struct BlasWork {
    const BlasBuild* build = nullptr;
    bool refit = false;
};
// Records builds and refits that share scratch memory: a build that does not fit beside the earlier ones
// waits for them. No dependency is recorded before the first build or after the last. Requires
// scratchBytesOf() bytes.
void recordBuilds(const Context::State& context, VkCommandBuffer commands, std::span<const BlasWork> works,
                  const ScratchRange& scratch);
// Returns the size of that memory: as much as all builds need, and at most 64 MiB unless one build needs
// more.
VkDeviceSize scratchBytesOf(const Context::State& context, std::span<const BlasWork> works);

}  // namespace glint

// Opacity micromaps on devices with VK_EXT_opacity_micromap.
#pragma once

#include "context/resources.h"

#include <glint/opacity_micromap.h>

#include <cstdint>
#include <span>
#include <vector>

namespace glint {

struct SceneUpload;

// Members are destroyed in reverse order: the micromap before its buffer.
struct DeviceMicromap {
    Buffer buffer;
    UniqueMicromap handle;                   // null if no triangle has a record
    Buffer indices;                          // 32 bits for each triangle
    std::vector<VkMicromapUsageEXT> usages;  // of triangles, as a BLAS asks for them
    std::uint64_t bytes = 0;                 // on the device
};

// Returns the highest level that the device takes, at most opacity::kMaxLevel; 0 without the extension.
std::uint32_t micromapLevel(const Context::State& context);

// Creates a micromap for each array, and queues their builds in the upload. Requires
// DeviceHandles::opacityMicromaps, and arrays within micromapLevel(). `pool` must outlive the result. Errors:
// those of memory and Vulkan's calls.
Result<std::vector<DeviceMicromap>> addMicromaps(SceneUpload& upload, MemoryPool& pool,
                                                 std::span<const opacity::MicromapArray> arrays);

// Describes how a geometry uses a micromap, for the chain of its triangles. Points into `micromap`.
VkAccelerationStructureTrianglesOpacityMicromapEXT describeMicromap(const DeviceMicromap& micromap);

}  // namespace glint

// Opacity micromaps on devices with VK_EXT_opacity_micromap.
#pragma once

#include "context/resources.h"

#include <glint/opacity_micromap.h>

#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// Members are destroyed in reverse order: the micromap before its buffer.
struct DeviceMicromap {
    Buffer buffer;
    UniqueMicromap handle;                   // null if no triangle has a record
    Buffer indices;                          // 32 bits for each triangle
    std::vector<VkMicromapUsageEXT> usages;  // of triangles, as a bottom level asks for them
    std::uint64_t bytes = 0;                 // on the device
};

// Returns the highest level that the device takes, at most opacity::kMaxLevel; 0 without the extension.
std::uint32_t micromapLevel(const Context::State& context);

// Builds a micromap for each array and waits for the device. Requires DeviceHandles::opacityMicromaps, and
// arrays within micromapLevel(). `pool` must outlive the result. Errors: those of buffers and submissions.
Result<std::vector<DeviceMicromap>> buildMicromaps(Context::State& context, MemoryPool& pool,
                                                   std::span<const opacity::MicromapArray> arrays);

// Describes how a geometry uses a micromap, for the chain of its triangles. Points into `micromap`.
VkAccelerationStructureTrianglesOpacityMicromapEXT describeMicromap(const DeviceMicromap& micromap);

}  // namespace glint

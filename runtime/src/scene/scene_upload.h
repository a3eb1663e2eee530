// The resources of a scene's upload that must stay until the device has completed it.
#pragma once

#include "context/commands.h"
#include "context/upload.h"
#include "data/acceleration.h"
#include "data/opacity_micromap.h"

#include <glint/scene.h>

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace glint {

// Its pool holds scratch and the inputs of acceleration structures, too.
struct SceneUpload : StagedCopies {
    using StagedCopies::StagedCopies;

    // Keeps a buffer of `pool`, if there is one, until the upload is complete.
    void keep(Buffer&& buffer) {
        if (buffer.handle.get() != VK_NULL_HANDLE) {
            kept.push_back(std::move(buffer));
        }
    }
};

// --- Opacity micromaps ---

// Returns the highest level that the device takes, at most opacity::kMaxLevel; 0 without the extension.
std::uint32_t micromapLevel(const Context::State& context);

// Creates a micromap for each array, and queues their builds in the upload. Requires
// DeviceHandles::opacityMicromaps, and arrays within micromapLevel(). `pool` must outlive the result. Errors:
// those of memory and Vulkan's calls.
Result<std::vector<DeviceMicromap>> addMicromaps(SceneUpload& upload, MemoryPool& pool,
                                                 std::span<const opacity::MicromapArray> arrays);

}  // namespace glint

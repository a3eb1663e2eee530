// What the upload of a scene needs until the device has completed it.
#pragma once

#include "context/timer.h"
#include "context/upload.h"
#include "motion/deformer.h"
#include "scene/compaction.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace glint {

struct SceneUpload {
    // `mostStaged` is that of Uploader::createDeferred().
    SceneUpload(Context::State& contextState, VkDeviceSize mostStaged)
        : context(contextState),
          pool(contextState),
          uploader(Uploader::createDeferred(contextState, pool, mostStaged)) {}

    // Keeps a buffer of `pool`, if there is one, until the upload is complete.
    void keep(Buffer&& buffer) {
        if (buffer.handle.get() != VK_NULL_HANDLE) {
            kept.push_back(std::move(buffer));
        }
    }

    // The stretches that `timer` measures.
    static constexpr std::uint32_t kBlasStretch = 0;
    static constexpr std::uint32_t kTlasStretch = 1;

    Context::State& context;
    // Of staging, scratch, and what acceleration structures are built from. Members are destroyed in reverse
    // order: the pool's memory last.
    MemoryPool pool;
    std::vector<Buffer> kept;
    std::unique_ptr<Uploader> uploader;  // all commands of the upload, in their order
    std::unique_ptr<Deformer> deformer;  // of a scene that does not move and is not in its rest pose
    std::optional<Timer> timer;
    std::uint32_t stretches = 0;             // that are recorded
    std::unique_ptr<Compaction> compaction;  // null if there is no BLAS to compact
    std::uint64_t frame = 0;                 // that the commands belong to
};

}  // namespace glint

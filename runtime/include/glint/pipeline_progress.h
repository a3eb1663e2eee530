// Pipelines that threads make while frames are drawn.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <optional>

namespace glint {

// The progress of the threads that make pipelines while frames are drawn.
struct PipelineProgress {
    std::uint32_t wanted = 0;   // pipelines that are made in the background
    std::uint32_t made = 0;     // those that were made, or have failed
    std::uint32_t adopted = 0;  // those that recordings use
    // The first error. Its passes keep the fallback, or the draft.
    std::optional<Diagnostic> error{};
    // True if the next recording may be a draft (RendererOptions::draft), and the number of drafts so far.
    bool draft = false;
    std::uint64_t drafts = 0;
};

}  // namespace glint

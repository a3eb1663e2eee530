// Reports about a renderer whose package is replaced by another one of the same scene.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace glint {

// The pipelines and buffers that Renderer::replacePackage() keeps, and those that it makes.
struct PackageReplacement {
    // Pipelines that the new package has in common with the earlier one: their SPIR-V is the same.
    std::uint32_t pipelinesKept = 0;
    // Pipelines that are made, in the call or in the background.
    std::uint32_t pipelinesMade = 0;
    // The shader IDs, in the new package, of the cases with a pipeline of their own that is made. Only
    // strategies with a dispatch for each case have such pipelines.
    std::vector<std::uint32_t> casesMade;
    // Buffers of the frame that have the size that the new package needs, and those that are made.
    std::uint32_t buffersKept = 0;
    std::uint32_t buffersMade = 0;
};

// The progress of the last replacement.
struct ReplacementProgress {
    std::uint64_t inUse = 0;    // replacements that recordings have begun to use
    bool pending = false;       // a package waits; recordings use the old one
    bool ready = false;         // the next recording uses the package that waits
    std::uint32_t missing = 0;  // pipelines that it still waits for
    // Recordings use an early package (PackageShape::early): they show the surfaces with edited features as
    // drafts, and all else as before the edit. The whole package follows.
    bool early = false;
    // Why the last replacement was given up; recordings continue with the old package. The next
    // replacePackage() clears it.
    std::optional<Diagnostic> error{};
};

}  // namespace glint

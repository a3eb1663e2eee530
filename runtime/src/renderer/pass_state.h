// The state that recordings of passes work on, of renderers and of RaySteps.
#pragma once

#include "context/commands.h"
#include "frame/frame_resources.h"
#include "renderer/pipelines.h"

#include <glint/renderer_options.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace glint {

// The largest number of passes of a round: the fixed ones of the longest strategy, and one for each case.
inline constexpr std::uint32_t kMaxFixedPasses = 27;

// The label of a timer's stretch.
struct PassLabel {
    std::string name;  // for people
    Pass pass = Pass::Frame;
    std::uint32_t shaderId = 0;  // the shader ID of Pass::ShadeCase
};

struct PassState {
    PassState(Context::State& contextState, Timer passTimer)
        : context(contextState), timer(std::move(passTimer)), frame(contextState), pipelines(contextState) {}

    Context::State& context;
    PipelineChoice choice;
    FrameSize size;
    std::vector<std::string> caseNames;
    Timer timer;
    FrameResources frame;
    Pipelines pipelines;
    std::uint32_t pushOffset = 0;  // bytes
    std::vector<PassLabel> timed;  // the last recording's label of each stretch of the timer
    bool recorded = false;
};

// Returns the times of the last recording. Errors: "frame-not-recorded", and those of reading device times.
Result<std::vector<PassTiming>> passTimings(PassState& state);

// Makes the error "frame-not-recorded".
Diagnostic frameNotRecorded();

}  // namespace glint

// What the passes of a Renderer work on.
#pragma once

#include "commands.h"
#include "frame_resources.h"
#include "gpu_scene_state.h"
#include "pipelines.h"
#include "timer.h"

#include <glint/renderer.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace glint {

// Passes of a round at most: the fixed ones of the longer strategy, and one a case.
inline constexpr std::uint32_t kMaxFixedPasses = 24;
// Rounds at most: one an effect with rays.
inline constexpr std::uint32_t kMaxRounds = package::rayEffectCount(package::kAllEffects);

// What a stretch of the timer is of.
struct PassLabel {
    std::string name;  // for people
    Pass pass = Pass::Frame;
    std::uint32_t shaderId = 0;  // of Pass::ShadeCase
};

struct Renderer::State {
    State(Context::State& contextState, GpuScene::State& sceneState, Timer passTimer)
        : context(contextState),
          scene(sceneState),
          timer(std::move(passTimer)),
          frame(contextState),
          pipelines(contextState) {}

    Context::State& context;
    GpuScene::State& scene;
    PipelineChoice choice;
    FrameSize size;
    std::vector<std::string> caseNames;
    Timer timer;
    FrameResources frame;
    Pipelines pipelines;
    // That set 1 names; alive as long as a recording may read it.
    std::shared_ptr<const Environment::State> environment;
    // Of the last recording.
    std::vector<PassLabel> timed;       // stretches of the timer
    std::vector<std::uint32_t> rounds;  // of rays: Effect bits of each
    bool recorded = false;
};

// Records all passes of a frame.
void recordFrame(Renderer::State& state, VkCommandBuffer commands, const FrameOptions& frame,
                 const gpu::FrameConstants& constants);

}  // namespace glint

// The state that the passes of a Renderer work on.
#pragma once

#include "context/commands.h"
#include "context/timer.h"
#include "renderer/frame_resources.h"
#include "renderer/pipelines.h"
#include "scene/gpu_scene_state.h"

#include <glint/renderer.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace glint {

// The largest number of passes of a round: the fixed ones of the longest strategy, and one for each case.
inline constexpr std::uint32_t kMaxFixedPasses = 24;
// The largest number of rounds: one for each effect with rays.
inline constexpr std::uint32_t kMaxRounds = package::rayEffectCount(package::kAllEffects);

// The label of a timer's stretch.
struct PassLabel {
    std::string name;  // for people
    Pass pass = Pass::Frame;
    std::uint32_t shaderId = 0;  // the shader ID of Pass::ShadeCase
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
    // The environment in set 1. It stays alive as long as a recording may read it.
    std::shared_ptr<const Environment::State> environment;
    // These describe the last recording.
    std::vector<PassLabel> timed;       // label of each stretch of the timer
    std::vector<std::uint32_t> rounds;  // Effect bits of each round of rays
    bool recorded = false;
};

// Records all passes of a frame.
void recordFrame(Renderer::State& state, VkCommandBuffer commands, const FrameOptions& frame,
                 const gpu::FrameConstants& constants);

}  // namespace glint

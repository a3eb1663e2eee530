// The state that the passes of a Renderer work on.
#pragma once

#include "frame/bounce_levels.h"
#include "frame/motion_history.h"
#include "renderer/pass_state.h"
#include "replacement/replacement.h"
#include "scene/gpu_scene_state.h"

#include <glint/renderer.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glint {

struct Renderer::State : PassState {
    State(Context::State& contextState, GpuScene::State& sceneState, Timer passTimer)
        : PassState(contextState, std::move(passTimer)), scene(sceneState) {}

    GpuScene::State& scene;
    std::vector<EffectName> effects;
    // The environment in set 1. It stays alive as long as a recording may read it.
    std::shared_ptr<const Environment::State> environment;
    // A list of rays of the last recording: the first of a round, or that of a further bounce.
    struct Round {
        std::uint32_t effects = 0;  // Effect bits
        std::uint32_t bounce = 1;
    };
    std::vector<Round> rounds;
    BounceLevels bounceLevels;
    std::unique_ptr<MotionHistory> history;  // null unless layers need it

    RendererOptions options;
    std::uint32_t timerCapacity = 0;  // stretches
    std::uint64_t recordings = 0;
    std::uint64_t drafts = 0;       // recordings that were drafts
    bool drafted = false;           // the last recording was one
    std::uint32_t firstSample = 0;  // FrameOptions::sampleIndex with which the picture began
    // The package of the scene that the pipelines are for, as ScenePackage::number.
    std::uint64_t scenePackage = 0;
    std::unique_ptr<NextPackage> next;  // null unless a package waits
    std::vector<std::unique_ptr<Leftovers>> leftovers;
    PipelineDisposal disposal;
    std::uint64_t replacementsInUse = 0;
    std::optional<Diagnostic> replacementError;
};

// Returns the number of bounces of a frame's paths.
inline std::uint32_t bouncesOf(const FrameSize& size, const FrameOptions& frame) {
    return frame.bounces == 0 ? size.bounces : std::min(frame.bounces, size.bounces);
}

// Returns the misses and hits by shader ID that the last recording counted, of all rounds. Hits must be
// ordered.
std::vector<std::uint32_t> bucketCountsOf(const Renderer::State& state);

// Records all passes of a frame.
void recordFrame(Renderer::State& state, VkCommandBuffer commands, const FrameOptions& frame,
                 const gpu::FrameConstants& constants);

}  // namespace glint

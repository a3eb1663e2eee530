// The state that the passes of a Renderer work on.
#pragma once

#include "context/commands.h"
#include "context/parallel.h"
#include "frame/bounce_levels.h"
#include "frame/frame_resources.h"
#include "frame/motion_history.h"
#include "renderer/background_pipelines.h"
#include "renderer/hit_passes.h"
#include "renderer/pipelines.h"
#include "renderer/replacement.h"
#include "scene/gpu_scene_state.h"

#include <glint/renderer.h>
#include <glint/renderer_options.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace glint {

// An effect of the package.
struct EffectName {
    package::Effect effect = 0;
    package::EffectInfo::Kind kind = package::EffectInfo::Kind::Rays;
    std::string name;
};

// Returns the effects whose names reports and labels need.
std::vector<EffectName> effectsOf(const Package& package);

struct Renderer::State final : PackageUser {
    State(Context::State& contextState, GpuScene::State& sceneState, Timer passTimer)
        : PackageUser(contextState, sceneState, std::move(passTimer)), scene(sceneState) {}

    package::Passes passes() const override {
        return package::Passes::Frame;
    }
    Status choose(const Package& other, NextPackage& made) const override;
    std::vector<std::uint32_t> hits() const override;
    // The pixels by what they see, in the form of hits().
    std::vector<std::uint32_t> firstHits() const;
    void took(const Package& taken) override;

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
    std::uint32_t shadowRounds = 0;  // as Renderer::Counters has it, of the last recording
    std::uint32_t orderedBands = 0;  // bands of the last recording whose first hits were ordered
    BounceLevels bounceLevels;
    std::unique_ptr<MotionHistory> history;  // null unless layers need it

    std::uint64_t drafts = 0;       // recordings that were drafts
    bool drafted = false;           // the last recording was one
    std::uint32_t firstSample = 0;  // FrameOptions::sampleIndex with which the picture began
};

// Returns the number of bounces of a frame's paths.
inline std::uint32_t bouncesOf(const FrameSize& size, const FrameOptions& frame) {
    return frame.bounces == 0 ? size.bounces : std::min(frame.bounces, size.bounces);
}

// Records all passes of a frame.
void recordFrame(Renderer::State& state, VkCommandBuffer commands, const FrameOptions& frame,
                 const gpu::FrameConstants& constants);

// Implements Renderer::readOutput().
Result<LinearImage> readPicture(const Renderer::State& state, CommandRunner& runner);

// Reads a whole buffer of the frame. Waits for the device.
Result<std::vector<std::uint8_t>> readFrameBuffer(const Renderer::State& state, CommandRunner& runner,
                                                  const Buffer& buffer);

}  // namespace glint

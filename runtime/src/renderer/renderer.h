// The state that the passes of a Renderer work on, and the package that is about to replace its own.
#pragma once

#include "context/commands.h"
#include "context/parallel.h"
#include "frame/bounce_levels.h"
#include "frame/frame_resources.h"
#include "frame/motion_history.h"
#include "renderer/background_pipelines.h"
#include "renderer/hit_passes.h"
#include "renderer/pipelines.h"
#include "scene/gpu_scene_state.h"

#include <glint/renderer.h>
#include <glint/renderer_options.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glint {

// An effect of the package.
struct EffectName {
    package::Effect effect = 0;
    package::EffectKind kind = package::EffectKind::Rays;
    std::string name;
};

// Returns the names of effects that reports and labels need of a package.
std::vector<EffectName> effectsOf(const Package& package);
std::vector<std::string> caseNamesOf(const Package& package);

// Returns the number of stretches that frames of the package can have.
std::uint32_t timerCapacity(const Package& package, const FrameSize& size);

// A package with all that its frames need, except pipelines that threads are still making. Members are
// destroyed in reverse order.
struct NextPackage {
    explicit NextPackage(Context::State& context) : pipelines(context) {}

    std::shared_ptr<const Package> package;
    Renderer::Replacement report;
    PackageFit fit;
    PipelineChoice choice;
    FrameSize size;
    std::optional<Timer> timer;  // no value: the renderer's own is long enough
    NextBuffers buffers;
    Pipelines pipelines;                           // with no pass yet
    std::vector<BackgroundPipelines::Done> ready;  // pipelines that are kept, or were made in the call
};

// Resources that only recordings up to `recording` use. Members are destroyed in reverse order.
struct Leftovers {
    std::uint64_t recording = 0;
    EarlierBuffers buffers;
    std::shared_ptr<const RetiredLot> scene;  // shared by the scene's renderers
    std::shared_ptr<const Environment::State> environment;
    UniqueDescriptorPool descriptors;  // of a set with that environment
    std::optional<Timer> timer;
    std::unique_ptr<NextPackage> next;  // one that was given up
    std::unique_ptr<Pipelines> pipelines;
};

// Destroys pipelines with jobs. A driver takes its time for each pipeline, and those that are being made have
// to be waited for. The destructor waits until all are gone.
class PipelineDisposal {
public:
    explicit PipelineDisposal(Jobs& jobs) : group_(jobs) {}
    // Never waits, unless there is no thread.
    void take(std::unique_ptr<Pipelines> pipelines, std::unique_ptr<NextPackage> next);

private:
    struct Waste {
        std::unique_ptr<NextPackage> next;
        std::unique_ptr<Pipelines> pipelines;
    };
    void destroyOne();

    std::mutex mutex_;
    std::vector<Waste> waste_;
    JobGroup group_;  // its jobs destroy a part of the waste each
};

// Implements Renderer::replacePackage() for all renderers of the scene.
Result<Renderer::Replacement> beginReplacement(Renderer::State& state,
                                               const std::shared_ptr<const Package>& package);

// Returns whether the pipelines of the package that waits are there, in all renderers of the scene.
bool isReplacementReady(const Renderer::State& state);
// Lets the package wait in renderers that were made after replacePackage(), too, and returns whether it is
// ready. If a pipeline could not be made, gives the package up.
bool joinReplacement(Renderer::State& state);
// Lets the commands that are recorded from now on use the package that waits, in all renderers of the scene.
// Requires joinReplacement(). If something can't be made, gives the package up, and nothing else changes.
void switchPackage(Renderer::State& state, VkCommandBuffer commands);

// Destroys resources that recordings after `recording` do not use; pipelines are gone some time later.
void releaseLeftovers(Renderer::State& state, std::uint64_t recording);

struct Renderer::State : PassState {
    State(Context::State& contextState, GpuScene::State& sceneState, Timer passTimer)
        : PassState(contextState, std::move(passTimer)), scene(sceneState), disposal(contextState.jobs) {}

    GpuScene::State& scene;
    std::shared_ptr<GpuScene::State::Renderers> renderers{};  // of the scene
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
    std::uint64_t drafts = 0;           // recordings that were drafts
    bool drafted = false;               // the last recording was one
    std::uint32_t firstSample = 0;      // FrameOptions::sampleIndex with which the picture began
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

// Reads one of the rgba32f images, given by its binding, row by row from the top. Waits for the device.
Result<std::vector<std::array<float, 4>>> readFrameImage(Renderer::State& state, CommandRunner& runner,
                                                         std::uint32_t binding);

// Reads a whole buffer of the frame. Waits for the device.
Result<std::vector<std::uint8_t>> readFrameBuffer(Renderer::State& state, CommandRunner& runner,
                                                  const Buffer& buffer);

}  // namespace glint

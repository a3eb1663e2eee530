// A package that is about to replace a renderer's, and the remains of earlier packages.
#pragma once

#include "context/timer.h"
#include "frame/frame_resources.h"
#include "renderer/background_pipelines.h"
#include "renderer/pipelines.h"
#include "replacement/scene_package.h"

#include <glint/package_replacement.h>
#include <glint/renderer.h>

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
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
    std::uint32_t scene = 0;  // index in the package
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
    SceneLeftovers scene;
    std::optional<Timer> timer;
    std::unique_ptr<NextPackage> next;  // one that was given up
    std::unique_ptr<Pipelines> pipelines;
};

// Destroys pipelines on threads of its own. A driver takes its time for each pipeline, and those that are
// being made have to be waited for. The destructor waits until all are gone.
class PipelineDisposal {
public:
    // Never waits, unless the system gives no thread.
    void take(std::unique_ptr<Pipelines> pipelines, std::unique_ptr<NextPackage> next);

private:
    std::vector<std::future<void>> running_;
};

// Implements Renderer::replacePackage().
Result<PackageReplacement> beginReplacement(Renderer::State& state, std::shared_ptr<const Package> package);

// If all pipelines of the package that waits are there, lets the commands that are recorded from now on use
// that package. If a pipeline could not be made, gives the package up.
void switchPackage(Renderer::State& state, VkCommandBuffer commands);

// Destroys resources that recordings after `recording` do not use; pipelines are gone some time later.
void releaseLeftovers(Renderer::State& state, std::uint64_t recording);

}  // namespace glint

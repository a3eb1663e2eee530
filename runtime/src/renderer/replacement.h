// Those who draw a scene with a package, and the package that is about to replace it.
#pragma once

#include "context/commands.h"
#include "context/parallel.h"
#include "data/retired.h"
#include "frame/frame_resources.h"
#include "renderer/background_pipelines.h"
#include "renderer/hit_passes.h"
#include "renderer/pipelines.h"
#include "scene/drawn_scene.h"

#include <glint/renderer_options.h>
#include <glint/scene.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace glint {

std::vector<std::string> caseNamesOf(const Package& package);

// Returns the number of stretches that frames of the package can have.
std::uint32_t timerCapacity(const Package& package, const FrameSize& size);

// A package with all that its frames need, except pipelines that threads are still making. Members are
// destroyed in reverse order.
struct NextPackage {
    explicit NextPackage(Context::State& context) : pipelines(context) {}

    std::shared_ptr<const Package> package;
    PackageReplacement report;
    PackageFit fit;
    std::uint32_t shaderIdsVersion = 0;  // of `fit`
    PipelineChoice choice;
    FrameSize size;
    std::optional<Timer> timer;  // no value: the present one is long enough
    NextBuffers buffers;
    Pipelines pipelines;                           // with no pass yet
    std::vector<BackgroundPipelines::Done> ready;  // pipelines that are kept, or were made in the call
};

// Resources that only recordings up to `recording` use. Members are destroyed in reverse order.
struct Leftovers {
    std::uint64_t recording = 0;
    std::vector<Buffer> buffers;
    std::shared_ptr<const RetiredLot> scene;  // shared by all who draw the scene
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
    // Takes pipelines, or what has some; null changes nothing. Never waits, unless there is no thread.
    void take(std::shared_ptr<void> waste);

private:
    void destroyOne();

    std::mutex mutex_;
    std::vector<std::shared_ptr<void>> waste_;
    JobGroup group_;  // its jobs destroy a part of the waste each
};

// A Renderer or RaySteps. All of a scene replace their packages together, when those of all agree about the
// scene's records. Those whose packages have the same passes share one.
struct PackageUser : PassState {
    PackageUser(Context::State& contextState, DrawnScene& drawnScene, Timer passTimer)
        : PassState(contextState, std::move(passTimer)),
          drawn(drawnScene),
          users(drawnScene.users),
          disposal(contextState.jobs) {}
    PackageUser(const PackageUser&) = delete;
    PackageUser& operator=(const PackageUser&) = delete;
    virtual ~PackageUser() = default;

    virtual package::Passes passes() const = 0;
    // Sets the choice and the size for frames of a package with these passes, or says why it does not suit.
    virtual Status choose(const Package& package, NextPackage& next) const = 0;
    // The misses and hits by shader ID that the last recording counted. Hits must be ordered.
    virtual std::vector<std::uint32_t> hits() const = 0;
    // Notes that recordings use the package from now on.
    virtual void took(const Package& package) = 0;

    DrawnScene& drawn;
    std::shared_ptr<DrawnScene::Users> users;  // of the scene
    RendererOptions options;
    std::shared_ptr<const Package> package;  // of create() it is kept by the caller
    std::uint64_t records = 0;               // recordsHash() of that package
    std::uint32_t shaderIdsVersion = 0;      // of the shader binding tables
    std::uint32_t timerCapacity = 0;         // stretches
    std::uint64_t recordings = 0;
    std::unique_ptr<NextPackage> next;  // null unless a package waits
    std::vector<std::unique_ptr<Leftovers>> leftovers;
    PipelineDisposal disposal;
    std::uint64_t replacementsInUse = 0;
    std::optional<Diagnostic> replacementError;
};

// Checks that the package has the passes, and that the scene's records are its own. Errors: "package-passes",
// "scene-package".
Status checkUse(package::Passes passes, const Package& package, const DrawnScene& scene);
// These begin and end the use of the scene with a package. A strategy with a pipeline of its own finds the
// shader of a hit by the instance of the TLAS, so DrawnScene::joinedBlases must be 0 before its recordings.
void enter(PackageUser& user, const Package& package);
void leave(PackageUser& user);

// Implements replacePackage() for all users of the scene whose packages have the same passes. The others may
// need a package of the same compilation, for which this one waits.
Result<PackageReplacement> beginReplacement(PackageUser& user, const std::shared_ptr<const Package>& package);
PackageProgress progressOf(const PackageUser& user);
// Gives up the package that waits, of all users whose packages have the same passes.
void withdraw(PackageUser& user);
// Lets the package wait for users that were made after replacePackage(), too, and returns whether it is
// ready. If a pipeline could not be made, gives the package up.
bool joinReplacement(PackageUser& user);
// Lets the commands that are recorded from now on use the package that waits, of all users. Requires
// joinReplacement(). If something can't be made, gives the package up, and nothing else changes.
void switchPackage(PackageUser& user, VkCommandBuffer commands);
// Error "package-replaced": the host has given an engine's scene the content of another package.
Status checkReplaced(const PackageUser& user);
// Makes the shader binding tables for the scene's present geometries, and pipelines that they need. Errors:
// those of create().
Status refreshTables(PackageUser& user);

// Makes all pipelines anew for another layout of the caller's, and those of a package that waits. With an
// error nothing changes. Errors: those of create().
Status replaceLayout(PackageUser& user, const LayoutSource& layout);

// Destroys resources that recordings after `recording` do not use; pipelines are gone some time later.
void releaseLeftovers(PackageUser& user, std::uint64_t recording);

}  // namespace glint

#include "renderer/pipelines.h"
#include "renderer/renderer.h"
#include "renderer/renderer_choice.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

namespace glint {
namespace {

using Done = BackgroundPipelines::Done;
using KnownPipelines = std::map<PipelineIdentity, MadePipeline>;

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

// Takes the pipelines that the threads of a waiting package have made so far.
void collect(NextPackage& next) {
    if (next.pipelines.background) {
        std::ranges::move(next.pipelines.background->take(kAll), std::back_inserter(next.ready));
    }
}

KnownPipelines knownPipelines(Renderer::State& state) {
    KnownPipelines known;
    for (const MadePipeline& made : state.pipelines.owned) {
        known.emplace(made.identity, made);
    }
    if (state.next) {
        collect(*state.next);
        for (const Done& done : state.next->ready) {
            known.emplace(done.made.identity, done.made);
        }
    }
    return known;
}

// Returns whether the pipeline only shades hits whose shader ID no case has, while the scene has none.
bool isSpare(const PlannedPipeline& planned, bool shadesUnknown) {
    const auto isFallback = [](const package::ModuleKey& key) {
        const package::RoleInfo& info = *package::findRole(key.role);
        return info.purpose == package::Purpose::Fallback && info.over != package::Over::Nothing;
    };
    const bool ofRays = planned.rays && isFallback(planned.rays->key);
    return !shadesUnknown &&
           (ofRays || (!planned.keys.empty() && std::ranges::all_of(planned.keys, isFallback)));
}

// Makes `missing` in this call.
Status makeNow(std::vector<PlannedPipeline> missing, const PipelineMaking& making,
               VkPipelineCreateFlags flags, NextPackage& next) {
    std::vector<PipelineJob> jobs;
    jobs.reserve(missing.size());
    for (const PlannedPipeline& planned : missing) {
        jobs.push_back(planned.job);
    }
    GLINT_TRY(auto made, makePipelines(jobs, flags, pipelineThreads(making.threads, jobs.size())));
    for (std::size_t i = 0; i < missing.size(); ++i) {
        next.ready.push_back({std::move(missing[i]), std::move(made[i])});
    }
    return okStatus();
}

// Plans the pipelines, keeps those that are known, and makes the others or starts threads that do.
Status makePipelinesOf(Renderer::State& state, NextPackage& next) {
    Renderer::Replacement& result = next.report;
    const PipelineMaking making{state.options.pipelineThreads, state.options.pipelineStatistics};
    const VkPipelineCreateFlags flags =
        making.captureStatistics ? VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR : 0;
    Pipelines& pipelines = next.pipelines;
    pipelines.package = next.package;
    pipelines.ownLayout = state.pipelines.ownLayout;
    pipelines.layout = state.pipelines.layout;
    pipelines.pushStages = state.pipelines.pushStages;
    pipelines.captureStatistics = making.captureStatistics;
    pipelines.adoptedAtOnce = state.pipelines.adoptedAtOnce;
    pipelines.threads = state.pipelines.threads;
    // Nothing stands in for pipelines: the package before is drawn until all are there.
    PipelineChoice choice = next.choice;
    choice.background = false;
    choice.draft = false;
    const std::vector<std::uint32_t>& shaderIds = next.fit.shaderIds;
    pipelines.shadesUnknown = hasUnknown(*next.package, shaderIds);
    const KnownPipelines known = knownPipelines(state);
    std::vector<PlannedPipeline> missing;
    for (PlannedPipeline& planned :
         planPipelines(state.context, *next.package, choice, shaderIds, pipelines.layout)) {
        planned.turn = isSpare(planned, pipelines.shadesUnknown) ? PipelineTurn::Spare : PipelineTurn::First;
        const auto kept = known.find(planned.job.identity);
        if (kept == known.end()) {
            std::ranges::copy(casesOf(planned), std::back_inserter(result.casesMade));
            missing.push_back(std::move(planned));
            continue;
        }
        MadePipeline made = kept->second;
        made.name = planned.job.name;
        next.ready.push_back({std::move(planned), std::move(made)});
    }
    std::ranges::sort(result.casesMade);
    result.pipelinesKept = static_cast<std::uint32_t>(next.ready.size());
    result.pipelinesMade = static_cast<std::uint32_t>(missing.size());
    if (!next.choice.background) {
        return makeNow(std::move(missing), making, flags, next);
    }
    if (!missing.empty()) {
        // One thread is the caller's.
        const std::uint32_t threads = pipelineThreads(making.threads, missing.size() + 1);
        pipelines.background = std::make_unique<BackgroundPipelines>(state.context.jobs, std::move(missing),
                                                                     flags, std::max(threads, 2U) - 1);
        if (state.recorded && state.size.ordered && next.size.bucketCount == state.size.bucketCount) {
            pipelines.background->setHits(bucketCountsOf(state));
        }
    }
    return okStatus();
}

// Makes everything that frames of the package need. Nothing of the renderer changes.
Result<std::unique_ptr<NextPackage>> makeNext(Renderer::State& state,
                                              std::shared_ptr<const Package> package) {
    if (package->passes() != package::Passes::Frame) {
        return makeError("package-passes", "", "the package has the steps of a host's own rays, and no frame",
                         "compile it with --passes frame");
    }
    GLINT_TRY(const auto choice, choosePipelines(state.context, *package, state.options));
    GLINT_TRY(auto fit, fitPackage(state.scene, package));
    auto next = std::make_unique<NextPackage>(state.context);
    next->choice = choice;
    next->report.missing = fit.missing;
    next->fit = std::move(fit);
    next->size = frameSize(*package, choice, state.options, textureCapacity(state.scene));
    GLINT_TRY_DO(checkFrameSize(state.context, next->size));
    if (!haveSameImages(state.size, next->size)) {
        return makeError(
            "package-frame", "",
            "the packages differ in layers, or only one of them reads an environment map or looks for "
            "reflections in screen space, so their frames have other images",
            "make a renderer for the package");
    }
    next->package = std::move(package);
    const std::uint32_t stretches = timerCapacity(*next->package, next->size);
    if (stretches > state.timerCapacity) {
        GLINT_TRY(auto timer, Timer::create(state.context, stretches));
        next->timer.emplace(std::move(timer));
    }
    GLINT_TRY(next->buffers, createNextBuffers(state.context, state.size, next->size));
    next->report.buffersKept = next->buffers.kept;
    next->report.buffersMade = next->buffers.made;
    GLINT_TRY_DO(makePipelinesOf(state, *next));
    return next;
}

// Leaves the package that waits, and the threads that make its pipelines, to releaseLeftovers().
void giveUp(Renderer::State& state) {
    if (state.next && state.next->pipelines.background) {
        state.next->pipelines.background->setPaused(true);
    }
    if (state.next) {
        state.leftovers.push_back(std::make_unique<Leftovers>());
        state.leftovers.back()->next = std::move(state.next);
    }
}

void pauseBackground(Renderer::State& state, bool paused) {
    if (state.pipelines.background) {
        state.pipelines.background->setPaused(paused);
    }
}

// Lets the passes use the pipelines, which are all there but for spare ones.
Status joinPasses(Renderer::State& state, NextPackage& next) {
    if (package::infoOf(next.choice.strategy).dispatchesCases) {
        next.pipelines.cases.resize(next.package->caseCount());
    }
    collect(next);
    for (const Done& done : next.ready) {
        GLINT_TRY_DO(addPipeline(state.context, done.planned, done.made, next.pipelines));
    }
    next.ready.clear();
    return okStatus();
}

// Returns the renderers of the scene.
std::vector<Renderer::State*> usersOf(GpuScene::State& scene) {
    const std::lock_guard lock(scene.renderers->mutex);
    std::vector<Renderer::State*> users;
    for (Renderer* const renderer : scene.renderers->all) {
        users.push_back(&renderer->state());
    }
    return users;
}

// Lets a package wait that was made by makeNext(). The threads make its pipelines first.
void await(Renderer::State& state, std::unique_ptr<NextPackage> next) {
    giveUp(state);
    pauseBackground(state, true);
    state.next = std::move(next);
    state.replacementError.reset();
}

void refuse(Renderer::State& state, const Diagnostic& error) {
    state.context.jobs.report(error);
    for (Renderer::State* const user : usersOf(state.scene)) {
        if (user->next) {
            user->replacementError = error;
            giveUp(*user);
            pauseBackground(*user, false);
        }
    }
}

bool waitsFor(const Renderer::State& state, const std::shared_ptr<const Package>& package) {
    return state.next && state.next->package == package;
}

// Makes the package that waits the renderer's own. `scene` are the leftovers of the scene, and `recording` is
// the last one that uses them. Nothing can fail.
void takeOver(Renderer::State& state, const std::shared_ptr<const RetiredLot>& scene,
              std::uint64_t recording) {
    NextPackage& next = *state.next;
    Leftovers& left = *state.leftovers.back();
    left.recording = recording;
    left.scene = scene;
    left.buffers = replaceBuffers(std::move(next.buffers), state.frame);
    *left.pipelines = std::exchange(state.pipelines, std::move(next.pipelines));
    if (next.timer) {
        left.timer.emplace(std::exchange(state.timer, std::move(*next.timer)));
        state.timerCapacity = timerCapacity(*next.package, next.size);
    }
    state.choice = next.choice;
    state.size = next.size;
    state.effects = effectsOf(*next.package);
    state.caseNames = caseNamesOf(*next.package);
    state.rounds.clear();
    state.bounceLevels.reset();
    state.recorded = false;
    ++state.replacementsInUse;
    state.next.reset();
}

}  // namespace

std::vector<EffectName> effectsOf(const Package& package) {
    std::vector<EffectName> effects;
    for (const package::EffectInfo& effect : package.effects()) {
        effects.push_back({effect.effect, effect.kind, std::string(effect.name)});
    }
    return effects;
}

std::vector<std::string> caseNamesOf(const Package& package) {
    std::vector<std::string> names;
    for (const package::CaseEntry& entry : package.cases()) {
        names.emplace_back(package.string(entry.name));
    }
    return names;
}

std::uint32_t timerCapacity(const Package& package, const FrameSize& size) {
    const std::uint32_t rounds = std::max(package::effectSlots(size.effects), 1U);
    return size.bandCount() * rounds * size.bounces * (kMaxFixedPasses + package.caseCount());
}

void PipelineDisposal::take(std::unique_ptr<Pipelines> pipelines, std::unique_ptr<NextPackage> next) {
    if (!pipelines && !next) {
        return;
    }
    try {
        {
            const std::lock_guard lock(mutex_);
            waste_.push_back({std::move(next), std::move(pipelines)});
        }
        group_.run([this] { destroyOne(); });
    } catch (const std::exception&) {
        destroyOne();  // there is no thread
    }
}

void PipelineDisposal::destroyOne() {
    Waste waste;
    const std::lock_guard lock(mutex_);
    if (!waste_.empty()) {
        waste = std::move(waste_.back());
        waste_.pop_back();
    }
}

Result<Renderer::Replacement> beginReplacement(Renderer::State& state,
                                               const std::shared_ptr<const Package>& package) {
    std::vector<std::pair<Renderer::State*, std::unique_ptr<NextPackage>>> made;
    for (Renderer::State* const user : usersOf(state.scene)) {
        if (user->pipelines.background) {
            GLINT_TRY_DO(adoptPipelines(user->context, user->pipelines));
        }
        if (user == &state || !waitsFor(*user, package)) {
            GLINT_TRY(auto next, makeNext(*user, package));
            made.emplace_back(user, std::move(next));
        }
    }
    for (auto& [user, next] : made) {
        await(*user, std::move(next));
    }
    return state.next->report;
}

bool isReplacementReady(const Renderer::State& state) {
    return std::ranges::all_of(usersOf(state.scene), [&](const Renderer::State* user) {
        const auto* const background = user->next ? user->next->pipelines.background.get() : nullptr;
        return waitsFor(*user, state.next->package) &&
               (background == nullptr || (user->pipelines.adoptedAtOnce > 0 && background->missing() == 0 &&
                                          !background->progress().error));
    });
}

bool joinReplacement(Renderer::State& state) {
    const std::shared_ptr<const Package> package = state.next->package;
    for (Renderer::State* const user : usersOf(state.scene)) {
        if (!waitsFor(*user, package)) {  // it was made after replacePackage()
            Result<std::unique_ptr<NextPackage>> next = makeNext(*user, package);
            if (!next) {
                refuse(state, next.error());
                return false;
            }
            await(*user, std::move(*next));
        }
        if (const auto& background = user->next->pipelines.background) {
            if (const std::optional<Diagnostic> error = background->progress().error) {
                refuse(state, *error);
                return false;
            }
        }
    }
    return isReplacementReady(state);
}

void switchPackage(Renderer::State& state, VkCommandBuffer commands) {
    const std::vector<Renderer::State*> users = usersOf(state.scene);
    for (Renderer::State* const user : users) {
        if (Status status = joinPasses(*user, *user->next); !status) {
            refuse(state, status.error());
            return;
        }
    }
    for (Renderer::State* const user : users) {
        user->leftovers.push_back(std::make_unique<Leftovers>());
        user->leftovers.back()->pipelines = std::make_unique<Pipelines>(user->context);
    }
    const auto left = std::make_shared<RetiredLot>();
    Result<RetiredLot> scene =
        recordReplacement(state.scene, state.next->package, state.next->fit.scene, commands);
    if (!scene) {
        refuse(state, scene.error());
        return;
    }
    *left = std::move(*scene);
    for (Renderer::State* const user : users) {
        // The commands that are being recorded read the staging memory.
        takeOver(*user, left, user->recordings + (user == &state ? 1 : 0));
    }
}

void releaseLeftovers(Renderer::State& state, std::uint64_t recording) {
    std::erase_if(state.leftovers, [&](const std::unique_ptr<Leftovers>& left) {
        if (left->recording > recording) {
            return false;
        }
        state.disposal.take(std::move(left->pipelines), std::move(left->next));
        return true;
    });
}

}  // namespace glint

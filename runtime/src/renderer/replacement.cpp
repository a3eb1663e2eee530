#include "renderer/pipelines.h"
#include "renderer/renderer.h"
#include "renderer/renderer_choice.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <limits>
#include <map>
#include <system_error>
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
Status makePipelinesOf(Renderer::State& state, NextPackage& next, PackageReplacement& result) {
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
    const std::vector<std::uint32_t> shaderIds = shaderIdsIn(state.scene, next.package->scene(next.scene));
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
        pipelines.background =
            std::make_unique<BackgroundPipelines>(std::move(missing), flags, std::max(threads, 2U) - 1);
        if (state.recorded && state.size.ordered && next.size.bucketCount == state.size.bucketCount) {
            pipelines.background->setHits(bucketCountsOf(state));
        }
    }
    return okStatus();
}

// Makes everything that frames of the package need. Nothing of the renderer changes.
Result<std::unique_ptr<NextPackage>> makeNext(Renderer::State& state, std::shared_ptr<const Package> package,
                                              PackageReplacement& result) {
    if (package->passes() != package::Passes::Frame) {
        return makeError("package-passes", "", "the package has the steps of a host's own rays, and no frame",
                         "compile it with --passes frame");
    }
    GLINT_TRY(const auto choice, choosePipelines(state.context, *package, state.options));
    GLINT_TRY(const auto scene, findScene(state.scene, *package));
    auto next = std::make_unique<NextPackage>(state.context);
    next->choice = choice;
    next->scene = scene;
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
    result.buffersKept = next->buffers.kept;
    result.buffersMade = next->buffers.made;
    GLINT_TRY_DO(makePipelinesOf(state, *next, result));
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

void refuse(Renderer::State& state, const Diagnostic& error) {
    state.replacementError = error;
    giveUp(state);
    pauseBackground(state, false);
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
    std::erase_if(running_, [](const std::future<void>& task) {
        return task.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
    if (!pipelines && !next) {
        return;
    }
    try {
        // The task may be copied, so its copies share the objects that it destroys.
        const auto taken =
            std::make_shared<std::pair<std::unique_ptr<Pipelines>, std::unique_ptr<NextPackage>>>(
                std::move(pipelines), std::move(next));
        running_.push_back(std::async(std::launch::async, [taken] {
            taken->first.reset();
            taken->second.reset();
        }));
    } catch (const std::system_error&) {
        // There is no thread, so this call has destroyed them.
    }
}

Result<PackageReplacement> beginReplacement(Renderer::State& state, std::shared_ptr<const Package> package) {
    PackageReplacement result;
    if (state.pipelines.background) {
        GLINT_TRY_DO(adoptPipelines(state.context, state.pipelines));
    }
    GLINT_TRY(auto next, makeNext(state, std::move(package), result));
    giveUp(state);
    // The threads make the pipelines of the new package instead.
    pauseBackground(state, true);
    state.next = std::move(next);
    state.replacementError.reset();
    return result;
}

void switchPackage(Renderer::State& state, VkCommandBuffer commands) {
    NextPackage& next = *state.next;
    if (next.pipelines.background) {
        if (const std::optional<Diagnostic> error = next.pipelines.background->progress().error) {
            refuse(state, *error);
            return;
        }
        if (next.pipelines.background->missing() > 0 || state.pipelines.adoptedAtOnce == 0) {
            return;
        }
    }
    if (Status status = joinPasses(state, next); !status) {
        refuse(state, status.error());
        return;
    }
    Result<RetiredLot> scene = recordReplacement(state.scene, *next.package, next.scene, commands);
    if (!scene) {
        refuse(state, scene.error());
        return;
    }
    state.leftovers.push_back(std::make_unique<Leftovers>());
    Leftovers& left = *state.leftovers.back();
    // The commands that are being recorded read the staging memory of `scene`.
    left.recording = state.recordings + 1;
    left.scene = std::move(*scene);
    left.buffers = replaceBuffers(std::move(next.buffers), state.frame);
    left.pipelines = std::make_unique<Pipelines>(std::exchange(state.pipelines, std::move(next.pipelines)));
    if (next.timer) {
        left.timer.emplace(std::exchange(state.timer, std::move(*next.timer)));
        state.timerCapacity = timerCapacity(*next.package, next.size);
    }
    state.choice = next.choice;
    state.size = next.size;
    state.effects = effectsOf(*next.package);
    state.caseNames = caseNamesOf(*next.package);
    state.scenePackage = state.scene.package.number;
    state.rounds.clear();
    state.bounceLevels.reset();
    state.recorded = false;
    ++state.replacementsInUse;
    state.next.reset();
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

#include "renderer/replacement.h"

#include "package/package.h"
#include "renderer/pipelines.h"

#include <glint/internal/package_modules.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace glint {
namespace {

using Done = BackgroundPipelines::Done;
using KnownPipelines = std::map<PipelineIdentity, MadePipeline>;

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

Status checkPasses(package::Passes passes, const Package& package) {
    if (package.passes() == passes) {
        return okStatus();
    }
    return package.passes() == package::Passes::Steps
               ? makeError("package-passes", "",
                           "the package has the steps of a host's own rays, and no frame",
                           "compile it with --passes frame, or use RaySteps")
               : makeError("package-passes", "", "the package draws frames, and has no steps",
                           "compile it with --passes steps, or use Renderer");
}

// Takes the pipelines that the threads of a waiting package have made so far.
void collect(NextPackage& next) {
    if (next.pipelines.background) {
        std::ranges::move(next.pipelines.background->take(kAll), std::back_inserter(next.ready));
    }
}

KnownPipelines knownPipelines(PackageUser& state) {
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
    return !shadesUnknown && std::ranges::all_of(planned.keys, isFallback);
}

// Plans the pipelines, keeps those that are known, and makes the others or starts threads that do. If
// `layout` is not null, the pipelines have this layout in place of the user's own, and none is kept.
Status makePipelinesOf(PackageUser& state, NextPackage& next, const LayoutSource* layout) {
    PackageReplacement& result = next.report;
    const PipelineMaking making{state.options.pipelineThreads, state.options.pipelineStatistics};
    Pipelines& pipelines = next.pipelines;
    pipelines.package = next.package;
    pipelines.ownLayout = state.pipelines.ownLayout;
    pipelines.layout = layout != nullptr ? layout->given : state.pipelines.layout;
    pipelines.pushStages = layout != nullptr ? layout->givenPushStages : state.pipelines.pushStages;
    pipelines.captureStatistics = making.captureStatistics;
    pipelines.adoptedAtOnce = state.pipelines.adoptedAtOnce;
    pipelines.threads = state.pipelines.threads;
    // Nothing stands in for pipelines: the package before is drawn until all are there.
    PipelineChoice choice = next.choice;
    choice.background = false;
    choice.draft = false;
    const std::vector<std::uint32_t>& shaderIds = next.fit.shaderIds;
    pipelines.shadesUnknown = hasUnknown(*next.package, shaderIds);
    const KnownPipelines known = layout == nullptr ? knownPipelines(state) : KnownPipelines();
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
    // A case has shaders for first hits and for hits of rays.
    std::ranges::sort(result.casesMade);
    result.casesMade.erase(std::unique(result.casesMade.begin(), result.casesMade.end()),
                           result.casesMade.end());
    result.pipelinesKept = static_cast<std::uint32_t>(next.ready.size());
    result.pipelinesMade = static_cast<std::uint32_t>(missing.size());
    if (!next.choice.background) {
        GLINT_TRY(auto made, makeNow(std::move(missing), making));
        std::ranges::move(made, std::back_inserter(next.ready));
        return okStatus();
    }
    if (!missing.empty()) {
        pipelines.background = makeLater(state.context, std::move(missing), making);
        if (state.recorded && next.size.bucketCount == state.size.bucketCount) {
            pipelines.background->setHits(state.hits());
        }
    }
    return okStatus();
}

// Makes everything that frames of the package need. Nothing of the user changes.
Result<std::unique_ptr<NextPackage>> makeNext(PackageUser& state, std::shared_ptr<const Package> package,
                                              bool inBackground, const LayoutSource* layout = nullptr) {
    GLINT_TRY_DO(checkPasses(state.passes(), *package));
    auto next = std::make_unique<NextPackage>(state.context);
    GLINT_TRY_DO(state.choose(*package, *next));
    next->choice.background = next->choice.background && inBackground;
    GLINT_TRY(next->fit, state.drawn.fit(package));
    next->shaderIdsVersion = state.drawn.shaderIdsVersion;
    next->report.missing = next->fit.missing;
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
    GLINT_TRY_DO(makePipelinesOf(state, *next, layout));
    return next;
}

// Leaves the package that waits, and the threads that make its pipelines, to releaseLeftovers().
void giveUp(PackageUser& state) {
    if (state.next && state.next->pipelines.background) {
        state.next->pipelines.background->setPaused(true);
    }
    if (state.next) {
        state.leftovers.push_back(std::make_unique<Leftovers>());
        state.leftovers.back()->next = std::move(state.next);
    }
}

void pauseBackground(PackageUser& state, bool paused) {
    if (state.pipelines.background) {
        state.pipelines.background->setPaused(paused);
    }
}

// Lets the passes use the pipelines, which are all there but for spare ones.
Status joinPasses(PackageUser& state, NextPackage& next) {
    next.pipelines.makeRoom(*next.package, next.choice.strategy);
    collect(next);
    for (const Done& done : next.ready) {
        GLINT_TRY_DO(addPipeline(state.context, done.planned, done.made, next.pipelines));
    }
    next.ready.clear();
    return okStatus();
}

// Returns all who draw the scene, and so replace their packages together.
std::vector<PackageUser*> usersWith(const PackageUser& state) {
    const std::lock_guard lock(state.users->mutex);
    return state.users->all;
}

// Returns the package that the user needs for a replacement with `state`, or null if it keeps the one it has.
std::shared_ptr<const Package> packageFor(const PackageUser& user, const PackageUser& state) {
    const std::unique_ptr<NextPackage>& next = user.passes() == state.passes() ? state.next : user.next;
    return next ? next->package : nullptr;
}

// Lets a package wait that was made by makeNext(). The threads make its pipelines first.
void await(PackageUser& state, std::unique_ptr<NextPackage> next) {
    giveUp(state);
    pauseBackground(state, true);
    state.next = std::move(next);
    state.replacementError.reset();
}

void refuse(PackageUser& state, const Diagnostic& error) {
    state.context.jobs.report(error);
    for (PackageUser* const user : usersWith(state)) {
        if (user->next) {
            user->replacementError = error;
            giveUp(*user);
            pauseBackground(*user, false);
        }
    }
}

bool waitsFor(const PackageUser& state, const std::shared_ptr<const Package>& package) {
    return state.next && state.next->package == package;
}

// Makes a package that joinPasses() has prepared the user's own. The last of its leftovers get what was
// replaced, and `scene`, the leftovers of the scene. `recording` is the last one that uses them. Nothing can
// fail.
void takeOver(PackageUser& state, std::unique_ptr<NextPackage> taken,
              const std::shared_ptr<const RetiredLot>& scene, std::uint64_t recording) {
    NextPackage& next = *taken;
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
    state.caseNames = caseNamesOf(*next.package);
    state.recorded = false;
    state.package = next.package;
    state.records = state.drawn.records;
    state.shaderIdsVersion = next.shaderIdsVersion;
    state.took(*next.package);
}

void addLeftovers(PackageUser& state) {
    state.leftovers.push_back(std::make_unique<Leftovers>());
    state.leftovers.back()->pipelines = std::make_unique<Pipelines>(state.context);
}

// Returns why a package can't replace another before the user does its part. Empty: nothing is left to do.
std::string reasonToWait(const PackageUser& user, const PackageUser& state) {
    const std::shared_ptr<const Package> wanted = packageFor(user, state);
    if (!wanted) {
        return user.records == state.next->fit.records
                   ? ""
                   : "needs a package of the same compilation: give it to replacePackage(), destroy it, or "
                     "withdrawPackage() gives up the one that waits";
    }
    if (!waitsFor(user, wanted) || user.next->fit.records != state.next->fit.records) {
        return user.passes() == state.passes() ? "joins with the next recording"
                                               : "waits for a package of another compilation";
    }
    const auto* const background = user.next->pipelines.background.get();
    if (background == nullptr) {
        return "";
    }
    if (background->missing() > 0) {
        return phrase("lacks ", background->missing(), " pipelines, which are being made");
    }
    if (background->progress().error) {
        return "could not make a pipeline";
    }
    return user.pipelines.adoptedAtOnce > 0 ? "" : "takes no pipelines in its recordings";
}

std::vector<std::string> reasonsToWait(const PackageUser& state) {
    std::vector<std::string> reasons;
    std::map<package::Passes, std::uint32_t> numbers;
    for (const PackageUser* const user : usersWith(state)) {
        const std::uint32_t number = ++numbers[user->passes()];
        if (const std::string reason = reasonToWait(*user, state); !reason.empty()) {
            const bool isRenderer = user->passes() == package::Passes::Frame;
            reasons.push_back(
                phrase((isRenderer ? "Renderer " : "RaySteps "), number, " of the scene ", reason));
        }
    }
    return reasons;
}

}  // namespace

std::vector<std::string> caseNamesOf(const Package& package) {
    std::vector<std::string> names;
    for (const package::CaseEntry& entry : package.cases()) {
        names.emplace_back(package.string(entry.name));
    }
    return names;
}

std::uint32_t timerCapacity(const Package& package, const FrameSize& size) {
    const std::uint32_t rounds = std::max(package::effectSlots(size.effects), 1U);
    const std::uint32_t first = kMaxFirstPasses + package.caseCount();
    return size.bandCount() * (first + rounds * size.bounces * (kMaxFixedPasses + package.caseCount()));
}

void PipelineDisposal::take(std::shared_ptr<void> waste) {
    if (waste == nullptr) {
        return;
    }
    try {
        {
            const std::lock_guard lock(mutex_);
            waste_.push_back(std::move(waste));
        }
        group_.run([this] { destroyOne(); });
    } catch (const std::exception&) {
        destroyOne();  // there is no thread
    }
}

void PipelineDisposal::destroyOne() {
    std::shared_ptr<void> waste;
    const std::lock_guard lock(mutex_);
    if (!waste_.empty()) {
        waste = std::move(waste_.back());
        waste_.pop_back();
    }
}

Status checkUse(package::Passes passes, const Package& package, const DrawnScene& scene) {
    GLINT_TRY_DO(checkPasses(passes, package));
    return checkRecords(package, scene.records);
}

void enter(PackageUser& state, const Package& package) {
    state.package = std::shared_ptr<const Package>(std::shared_ptr<void>(), &package);
    state.records = state.drawn.records;
    state.shaderIdsVersion = state.drawn.shaderIdsVersion;
    const bool readsTables = package::infoOf(state.choice.strategy).ownPipeline;
    {
        const std::lock_guard lock(state.users->mutex);
        state.users->all.push_back(&state);
        state.users->readTables = state.users->readTables || readsTables;
    }
    if (readsTables) {
        state.drawn.partBlases();
    }
}

void leave(PackageUser& state) {
    const std::lock_guard lock(state.users->mutex);
    std::erase(state.users->all, &state);
}

Result<PackageReplacement> beginReplacement(PackageUser& state,
                                            const std::shared_ptr<const Package>& package) {
    std::vector<std::pair<PackageUser*, std::unique_ptr<NextPackage>>> made;
    for (PackageUser* const user : usersWith(state)) {
        if (user->passes() != state.passes()) {
            continue;
        }
        if (user->pipelines.background) {
            GLINT_TRY_DO(adoptPipelines(user->context, user->pipelines));
        }
        if (user == &state || !waitsFor(*user, package)) {
            GLINT_TRY(auto next, makeNext(*user, package, true));
            made.emplace_back(user, std::move(next));
        }
    }
    for (auto& [user, next] : made) {
        await(*user, std::move(next));
    }
    return state.next->report;
}

PackageProgress progressOf(const PackageUser& state) {
    PackageProgress progress;
    progress.inUse = state.replacementsInUse;
    progress.error = state.replacementError;
    if (state.next) {
        const auto& background = state.next->pipelines.background;
        progress.pending = true;
        progress.missing = background ? background->missing() : 0;
        progress.waitsFor = reasonsToWait(state);
        progress.ready = progress.waitsFor.empty();
    }
    return progress;
}

void withdraw(PackageUser& state) {
    for (PackageUser* const user : usersWith(state)) {
        if (user->next && user->passes() == state.passes()) {
            giveUp(*user);
            pauseBackground(*user, false);
        }
    }
}

bool joinReplacement(PackageUser& state) {
    for (PackageUser* const user : usersWith(state)) {
        const std::shared_ptr<const Package> wanted = packageFor(*user, state);
        if (!wanted) {
            continue;
        }
        // It was made after replacePackage(), or the scene has had other geometries since then.
        if (!waitsFor(*user, wanted) || user->next->shaderIdsVersion != user->drawn.shaderIdsVersion) {
            Result<std::unique_ptr<NextPackage>> next = makeNext(*user, wanted, true);
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
    return reasonsToWait(state).empty();
}

void switchPackage(PackageUser& state, VkCommandBuffer commands) {
    std::vector<PackageUser*> users = usersWith(state);
    std::erase_if(users, [](const PackageUser* user) { return !user->next; });
    // The scene gets the package that needs most of it: emissive triangles.
    const auto needs = [](const PackageUser* user) {
        const Package& next = *user->next->package;
        return std::pair(next.emission() != nullptr, user->passes() == package::Passes::Frame);
    };
    const NextPackage& leading = *(*std::ranges::max_element(users, {}, needs))->next;
    for (PackageUser* const user : users) {
        if (Status status = joinPasses(*user, *user->next); !status) {
            refuse(state, status.error());
            return;
        }
    }
    for (PackageUser* const user : users) {
        addLeftovers(*user);
    }
    const auto left = std::make_shared<RetiredLot>();
    Result<RetiredLot> scene = state.drawn.recordReplacement(leading.package, leading.fit.scene, commands);
    if (!scene) {
        refuse(state, scene.error());
        return;
    }
    *left = std::move(*scene);
    for (PackageUser* const user : users) {
        // The commands that are being recorded read the staging memory.
        takeOver(*user, std::move(user->next), left, user->recordings + (user == &state ? 1 : 0));
        ++user->replacementsInUse;
    }
}

Status checkReplaced(const PackageUser& state) {
    if (state.drawn.records != state.records) {
        return makeError("package-replaced", "",
                         "EngineScene::update() has given the scene the content of another package",
                         "give that package to replacePackage()");
    }
    return okStatus();
}

Status refreshTables(PackageUser& state) {
    if (state.shaderIdsVersion == state.drawn.shaderIdsVersion) {
        return okStatus();
    }
    if (package::infoOf(state.choice.strategy).ownPipeline) {
        GLINT_TRY(auto next, makeNext(state, state.package, false));
        GLINT_TRY_DO(joinPasses(state, *next));
        addLeftovers(state);
        takeOver(state, std::move(next), nullptr, state.recordings);
    }
    state.pipelines.shadesUnknown = hasUnknown(*state.package, state.drawn.shaderIds);
    state.shaderIdsVersion = state.drawn.shaderIdsVersion;
    return okStatus();
}

Status replaceLayout(PackageUser& state, const LayoutSource& layout) {
    GLINT_TRY(auto now, makeNext(state, state.package, false, &layout));
    GLINT_TRY_DO(joinPasses(state, *now));
    std::unique_ptr<NextPackage> waiting;
    if (state.next) {
        GLINT_TRY(waiting, makeNext(state, state.next->package, true, &layout));
    }
    addLeftovers(state);
    takeOver(state, std::move(now), nullptr, state.recordings);
    if (waiting) {
        await(state, std::move(waiting));
    }
    return okStatus();
}

void releaseLeftovers(PackageUser& state, std::uint64_t recording) {
    std::erase_if(state.leftovers, [&](const std::unique_ptr<Leftovers>& left) {
        if (left->recording > recording) {
            return false;
        }
        state.disposal.take(std::move(left->pipelines));
        state.disposal.take(std::move(left->next));
        return true;
    });
}

}  // namespace glint

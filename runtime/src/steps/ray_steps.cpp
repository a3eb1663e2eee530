#include "context/parallel.h"
#include "frame/frame_constants.h"
#include "package/package.h"
#include "renderer/hit_passes.h"
#include "renderer/pipelines.h"
#include "renderer/replacement.h"
#include "steps/engine_scene.h"

#include <glint/steps.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <utility>

namespace glint {

static_assert(sizeof(RaySteps::Ray) == sizeof(gpu::RayRecord));
static_assert(offsetof(RaySteps::Ray, slot) == offsetof(gpu::RayRecord, target));
static_assert(offsetof(RaySteps::Ray, coneSpread) == offsetof(gpu::RayRecord, coneSpread));
static_assert(sizeof(RaySteps::Hit) == sizeof(gpu::HitRecord));
static_assert(offsetof(RaySteps::Hit, barycentrics) == offsetof(gpu::HitRecord, barycentricU));
static_assert(offsetof(RaySteps::Hit, coneWidth) == offsetof(gpu::HitRecord, coneWidth));
static_assert(RaySteps::Hit::kMiss == gpu::kMissGeometry);
static_assert(sizeof(RaySteps::VisibilityRay) == sizeof(gpu::VisibilityRay));
static_assert(offsetof(RaySteps::VisibilityRay, slot) == offsetof(gpu::VisibilityRay, target));
static_assert(offsetof(RaySteps::VisibilityRay, distance) == offsetof(gpu::VisibilityRay, distance));
static_assert(sizeof(RaySteps::Surface) == sizeof(gpu::SurfaceRecord));
static_assert(offsetof(RaySteps::Surface, roughness) == offsetof(gpu::SurfaceRecord, roughness));
static_assert(offsetof(RaySteps::Surface, f0) == offsetof(gpu::SurfaceRecord, f0));
static_assert(offsetof(RaySteps::Surface, motion) == offsetof(gpu::SurfaceRecord, motion));
static_assert(RaySteps::Surface::kMiss == gpu::kSurfaceMiss &&
              RaySteps::Surface::kUnknown == gpu::kSurfaceUnknown);
static_assert(RaySteps::kPushBytes == sizeof(gpu::PushConstants));

struct RaySteps::State final : PackageUser {
    State(Context::State& contextState, EngineScene::State& sceneState, Timer passTimer)
        : PackageUser(contextState, sceneState.drawn(), std::move(passTimer)), scene(sceneState) {}

    package::Passes passes() const override {
        return package::Passes::Steps;
    }
    Status choose(const Package& other, NextPackage& made) const override;
    std::vector<std::uint32_t> hits() const override;
    void took(const Package& /*taken*/) override {}

    EngineScene::State& scene;
    bool tlasByAddress = false;
    // These belong to the batch that begin() started.
    Timing timing = Timing::Frame;
    std::uint32_t whole = 0;  // the timer's stretch of it
    bool visibility = false;
    std::uint32_t bounces = 1;
    std::shared_ptr<const Environment::State> environment;
};

namespace {

Diagnostic wrongBatch(const std::string& what, const std::string& hint) {
    return makeError("ray-steps", "", what, hint);
}

Outside outsideOf(const RaySteps::Batch& batch) {
    return {batch.sky, batch.environment, batch.environmentRotation, batch.environmentIntensity};
}

// The options with as many bounces as the package has.
RendererOptions optionsFor(const Package& package, RendererOptions options) {
    options.bounces = package.shape().maxBounces;
    return options;
}

Status checkHits(const RaySteps::State& state, const RaySteps::Batch& batch) {
    if (batch.hits != 0 && batch.visibility) {
        return wrongBatch("rays that only ask for visibility have no hits",
                          "leave out RaySteps::Batch::hits");
    }
    if (batch.hits != 0 && package::infoOf(state.choice.strategy).ownPipeline) {
        return wrongBatch("the strategy " + std::string(nameOf(state.choice.strategy)) +
                              " shades hits where its pipeline finds them, and takes none",
                          "make RaySteps with another strategy for RaySteps::Batch::hits");
    }
    return okStatus();
}

Status checkBatch(const RaySteps::State& state, const RaySteps::Batch& batch) {
    if (batch.rays == 0 || batch.answers == 0) {
        return wrongBatch("the address of rays or answers is 0", "give the addresses of both lists");
    }
    if (state.tlasByAddress && batch.tlas == 0) {
        return wrongBatch(
            "the package takes the acceleration structure by address, and RaySteps::Batch::tlas is 0",
            "set it, or compile the package with a number for tlas in --bindings");
    }
    if (batch.countAddress == 0 && batch.rayCount > state.options.width) {
        return wrongBatch(
            phrase(batch.rayCount, " rays are more than RaySteps::Options::maxRays, ", state.options.width),
            "split the batch, or make the steps for more rays");
    }
    if (batch.bounces > state.size.bounces) {
        return makeError(
            "package-bounces", "",
            phrase("paths of ", batch.bounces,
                   " bounces are asked for, and the package was compiled for 1 to ", state.size.bounces),
            "compile the package with more --bounces, or ask for fewer");
    }
    GLINT_TRY_DO(checkHits(state, batch));
    return batch.visibility ? okStatus() : checkOutside(state.size, outsideOf(batch));
}

Status checkLayout(VkPipelineLayout layout) {
    return layout != VK_NULL_HANDLE
               ? okStatus()
               : Status(wrongBatch("there is no pipeline layout", "give that of the host's pipelines"));
}

Status checkRays(const Context::State& context, const FrameSize& size, std::uint32_t maxRays) {
    const std::uint64_t most = std::min<std::uint64_t>(
        size.rayPipeline ? maxRayDispatch(context.limits) : std::numeric_limits<std::uint32_t>::max(),
        context.limits.maxBufferBytes / sizeof(gpu::ShadowRecord));
    if (maxRays == 0 || listSlots(size) > most) {
        return wrongBatch("maxRays is " + std::to_string(maxRays),
                          "use 1 to " + std::to_string(most - (listSlots(size) - listRays(size))));
    }
    return okStatus();
}

std::vector<std::uint32_t> countersAt(const PassState& state, VkDeviceSize offset, std::size_t count) {
    std::vector<std::uint32_t> values(count);
    std::memcpy(values.data(), state.frame.readback.mapped + offset, count * sizeof values[0]);
    return values;
}

}  // namespace

Status RaySteps::State::choose(const Package& other, NextPackage& made) const {
    if (other.bindings() != package->bindings() || other.answer() != package->answer() ||
        other.environmentMap() != package->environmentMap()) {
        return wrongBatch("the packages differ in bindings, answers or the use of an environment map",
                          "compile it with the options of the package before, or make other RaySteps");
    }
    const RendererOptions wanted = optionsFor(other, options);
    GLINT_TRY(made.choice, choosePipelines(context, other, wanted));
    made.size = frameSize(other, made.choice, wanted, 0);
    return checkRays(context, made.size, options.width);
}

std::vector<std::uint32_t> RaySteps::State::hits() const {
    std::vector<std::uint32_t> sum(size.ordered ? size.bucketCount : 0);
    for (std::uint32_t round = 0; round < bounces && !sum.empty(); ++round) {
        const VkDeviceSize place = readbackRound(size, round) + kRoundCounterBytes;
        std::ranges::transform(sum, countersAt(*this, place, sum.size()), sum.begin(), std::plus());
    }
    return sum;
}

Result<std::unique_ptr<RaySteps>> RaySteps::create(Context& context, const Package& package,
                                                   EngineScene& scene, const RaySteps::Options& options) try {
    Context::State& contextState = context.state();
    DrawnScene& drawn = scene.state().drawn();
    GLINT_TRY_DO(checkUse(package::Passes::Steps, package, drawn));
    GLINT_TRY_DO(checkLayout(options.layout));
    RendererOptions wanted;
    wanted.strategy = options.strategy;
    wanted.tracer = options.tracer;
    wanted.ordering = options.ordering;
    wanted.checkOrder = options.checkOrder;
    wanted.backgroundPipelines = options.backgroundPipelines;
    wanted.pipelineThreads = options.pipelineThreads;
    wanted.draft = false;
    wanted.width = options.maxRays;
    wanted.height = 1;
    wanted = optionsFor(package, wanted);
    GLINT_TRY(auto choice, choosePipelines(contextState, package, wanted));
    const FrameSize size = frameSize(package, choice, wanted, 0);
    GLINT_TRY_DO(checkRays(contextState, size, options.maxRays));
    const std::uint32_t stretches = timerCapacity(package, size);
    GLINT_TRY(auto timer, Timer::create(contextState, stretches));
    auto state = std::make_unique<State>(contextState, scene.state(), std::move(timer));
    state->choice = choice;
    state->size = size;
    state->options = wanted;
    state->options.tracer = choice.tracer;  // for which the host binds its sets
    state->timerCapacity = stretches;
    state->pushOffset = package.bindings().pushOffset;
    state->tlasByAddress = package.bindings().tlas == package::Bindings::kByAddress;
    state->caseNames = caseNamesOf(package);
    GLINT_TRY_DO(createFrameResources(contextState, size, state->frame));
    GLINT_TRY(state->pipelines,
              createPipelines(contextState, package, choice, {options.pipelineThreads, false},
                              drawn.shaderIds, {{}, options.layout, options.pushStages}));
    enter(*state, package);
    return std::unique_ptr<RaySteps>(new RaySteps(std::move(state)));
}
GLINT_CATCH

RaySteps::RaySteps(std::unique_ptr<State> state) : state_(std::move(state)) {}

RaySteps::~RaySteps() {
    leave(*state_);
}

namespace {

gpu::FrameConstants makeConstants(const RaySteps::State& state, const RaySteps::Batch& batch) {
    gpu::FrameConstants constants{};
    constants.width = state.options.width;
    constants.height = 1;
    constants.sampleIndex = batch.sampleIndex;
    constants.seed = batch.seed;
    constants.time = batch.time;
    constants.effects = state.size.effects.all;
    constants.maxSampleRadiance = std::numeric_limits<float>::infinity();
    constants.lengthUnit = constants.perLengthUnit = 1.0F;
    fillOutside(outsideOf(batch), constants);
    state.scene.fill(constants);
    constants.rayMask = batch.mask;
    constants.tlasAddress = {static_cast<std::uint32_t>(batch.tlas),
                             static_cast<std::uint32_t>(batch.tlas >> 32)};
    fillLists(state.frame, state.size, constants);
    constants.rays = batch.rays;
    constants.visibilityRays = batch.rays;
    constants.rayCount = batch.countAddress != 0 ? batch.countAddress : state.frame.counters.address;
    constants.givenHits = batch.hits;
    constants.givesHits = batch.hits != 0 ? 1 : 0;
    constants.radiance = batch.answers;
    constants.surfaces = batch.answers;
    constants.visibilities = batch.answers;
    constants.bounce = 1;
    constants.bounceWeight = 1.0F;
    constants.lastBounce = state.bounces;
    return constants;
}

// Records passes under the label of their step.
template <typename Record>
void recordStep(RaySteps::State& state, VkCommandBuffer commands, const char* name, const Record& record) {
    PassRecorder passes(state, commands, state.timing);
    beginLabel(state.context, commands, name);
    record(passes);
    endLabel(state.context, commands);
}

}  // namespace

Status RaySteps::begin(VkCommandBuffer commands, const RaySteps::Batch& batch) try {
    GLINT_TRY_DO(checkBatch(*state_, batch));
    GLINT_TRY_DO(adoptPipelines(state_->context, state_->pipelines));
    if (state_->next && joinReplacement(*state_)) {
        if (!batch.visibility) {
            GLINT_TRY_DO(checkOutside(state_->next->size, outsideOf(batch)));
        }
        switchPackage(*state_, commands);
    }
    GLINT_TRY_DO(checkReplaced(*state_));
    GLINT_TRY_DO(refreshTables(*state_));
    state_->timed.clear();
    state_->timing = batch.timing;
    state_->visibility = batch.visibility;
    state_->bounces = batch.visibility ? 1 : batch.bounces == 0 ? state_->size.bounces : batch.bounces;
    if (batch.environment != nullptr) {
        state_->environment = batch.environment->state();
    }
    state_->timer.recordReset(commands);
    recordStep(*state_, commands, "begin", [&](PassRecorder& passes) {
        passes.barrier(kAllToAll);
        state_->whole = passes.beginStretch({"rays", Pass::Hits});
        passes.fill(state_->frame.counters, 0);
        passes.clearLists();
        passes.setConstants(makeConstants(*state_, batch));
        if (batch.countAddress == 0) {
            passes.barrier(kTransferToTransfer);
            static_assert(gpu::kCounterRays == 0);
            state_->context.vk.CmdUpdateBuffer(commands, state_->frame.counters.handle.get(), 0,
                                               sizeof(batch.rayCount), &batch.rayCount);
        }
        passes.barrier(passes.dependencies().clearToPasses);
        HitPasses(*state_, passes).dispatchOfList();
    });
    state_->recorded = true;
    ++state_->recordings;
    return okStatus();
}
GLINT_CATCH

void RaySteps::trace(VkCommandBuffer commands) {
    recordStep(*state_, commands, "trace", [&](PassRecorder& passes) {
        HitPasses hits(*state_, passes);
        if (state_->visibility) {
            hits.traceVisibility();
        } else {
            hits.trace();
        }
    });
}

void RaySteps::order(VkCommandBuffer commands) {
    if (!state_->visibility) {
        recordStep(*state_, commands, "order",
                   [&](PassRecorder& passes) { HitPasses(*state_, passes).order(); });
    }
}

void RaySteps::shade(VkCommandBuffer commands) {
    recordStep(*state_, commands, "shade", [&](PassRecorder& passes) {
        HitPasses hits(*state_, passes);
        if (!state_->visibility) {
            hits.shade();
        }
        hits.readBackRound(0);
        for (std::uint32_t bounce = 2; bounce <= state_->bounces; ++bounce) {
            hits.listPathRays(bounce, 1.0F);
            hits.dispatchOfList();
            hits.trace();
            hits.order();
            hits.shade();
            hits.readBackRound(bounce - 1);
        }
        passes.endStretch(state_->whole);
        // The counters go to host memory, and the answers to the host's next commands.
        passes.barrier(kAllToAll);
        passes.readBack(state_->frame.counters, counterBytes(state_->size), 0);
        passes.barrier(kCopyToHost);
    });
}

Status RaySteps::record(VkCommandBuffer commands, const RaySteps::Batch& batch) try {
    GLINT_TRY_DO(begin(commands, batch));
    trace(commands);
    order(commands);
    shade(commands);
    return okStatus();
}
GLINT_CATCH

Result<RaySteps::Counters> RaySteps::counters() try {
    GLINT_TRY_DO(checkRecorded(*state_));
    const std::vector<std::uint32_t> values =
        countersAt(*state_, 0, counterBytes(state_->size) / sizeof(std::uint32_t));
    Counters result;
    static_assert(gpu::kCounterRays == 0 && gpu::kCounterShadowRays == 1);
    for (std::uint32_t round = 0; round < state_->bounces; ++round) {
        const std::vector<std::uint32_t> lists = countersAt(*state_, readbackRound(state_->size, round), 2);
        (round == 0 ? result.rays : result.furtherRays) += lists[gpu::kCounterRays];
        result.shadowRays += lists[gpu::kCounterShadowRays];
    }
    result.unknownShader = values[gpu::kCounterUnknownShader];
    result.orderErrors = values[gpu::kCounterOrderErrors];
    if (state_->size.ordered) {
        result.bucketCounts = state_->hits();
    }
    return result;
}
GLINT_CATCH

Result<std::vector<PassTiming>> RaySteps::timings() try { return passTimings(*state_); }
GLINT_CATCH

Result<PackageReplacement> RaySteps::replacePackage(const std::shared_ptr<const Package>& package) try {
    return beginReplacement(*state_, package);
}
GLINT_CATCH

PackageProgress RaySteps::replacementProgress() const {
    return progressOf(*state_);
}

void RaySteps::withdrawPackage() {
    withdraw(*state_);
}

Status RaySteps::setLayout(VkPipelineLayout layout, VkShaderStageFlags pushStages) try {
    GLINT_TRY_DO(checkLayout(layout));
    return replaceLayout(*state_, {{}, layout, pushStages});
}
GLINT_CATCH

std::uint64_t RaySteps::recordings() const {
    return state_->recordings;
}

void RaySteps::finished(std::uint64_t recording) {
    releaseLeftovers(*state_, recording);
}

package::Tracer RaySteps::tracer() const {
    return state_->choice.tracer;
}

package::Ordering RaySteps::ordering() const {
    return state_->choice.ordering;
}

std::uint64_t RaySteps::bytes() const {
    std::uint64_t sum = 0;
    for (const auto& [name, buffer] : buffersOf(state_->frame, state_->size)) {
        sum += buffer->bytes;
    }
    return sum;
}

}  // namespace glint

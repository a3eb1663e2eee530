// Renderer: creation, frame constants, results.
#include "renderer/renderer.h"

#include "context/parallel.h"
#include "context/resources.h"
#include "context/vulkan_table.h"
#include "frame/frame_constants.h"
#include "frame/motion_history.h"
#include "package/package.h"
#include "renderer/background_pipelines.h"
#include "renderer/pipeline_jobs.h"
#include "renderer/pipelines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <string_view>
#include <utility>

namespace glint {
namespace {

// A ray of this length leaves any scene. It equals kFarDistance of shaders.
constexpr float kFarDistance = 1e18F;
// The largest number of rays a pixel and sample, to one light or for ambient occlusion.
constexpr std::uint32_t kMaxSurfaceSamples = 4096;
constexpr std::uint32_t kMaxInterfaces = 64;

// `made` are the options that the renderer was made with.
Status checkFrame(const FrameOptions& frame, const RendererOptions& made) {
    GLINT_TRY_DO(checkCamera(frame.camera));
    const auto isOutside = [](std::uint32_t value, std::uint32_t most) { return value == 0 || value > most; };
    const auto isNegative = [](float value) { return !std::isfinite(value) || value < 0.0F; };
    const struct {
        bool isBroken;
        std::string what;
        std::string hint;
    } rules[] = {
        {frame.sampleIndex > 0 && !made.accumulate,
         phrase("sample ", frame.sampleIndex,
                " of a picture is asked of a renderer that does not accumulate"),
         "set RendererOptions::accumulate, or use 0 for sampleIndex"},
        {frame.screenSteps > 0 && !made.screenMarch,
         "screenSteps is asked of a renderer that was made without the march in screen space",
         "set RendererOptions::screenMarch, or use 0 for screenSteps"},
        {!std::isfinite(frame.maxReflectionRoughness) || !std::isfinite(frame.mirrorRoughness),
         "a limit of roughness is not finite", "use 0 to 1"},
        {isNegative(frame.faintWeight), "faintWeight is negative or not finite", "use 0 to 1"},
        {isOutside(frame.shadowSamples, kMaxSurfaceSamples) ||
             isOutside(frame.occlusionSamples, kMaxSurfaceSamples),
         "shadowSamples or occlusionSamples is 0 or above the limit",
         phrase("use 1 to ", kMaxSurfaceSamples)},
        {!(frame.occlusionRadius > 0.0F) || (frame.occlusionFalloff && !std::isfinite(frame.occlusionRadius)),
         "occlusionRadius is not above 0, or infinite where occluders count less with distance",
         "use metres, or infinity without the falloff"},
        {isOutside(frame.maxInterfaces, kMaxInterfaces), "maxInterfaces is 0 or above the limit",
         phrase("use 1 to ", kMaxInterfaces)},
        {frame.bounces > made.bounces,
         phrase("frames of ", frame.bounces, " bounces need a renderer for as many"),
         phrase("use 0 to ", made.bounces, ", or set RendererOptions::bounces")},
        {!(frame.maxSampleRadiance > 0.0F), "maxSampleRadiance is not above 0",
         "use a luminance, or infinity for no limit"},
        {!std::isfinite(frame.time), "time is not finite", "use seconds"},
        {isNegative(frame.screenThickness), "screenThickness is negative or not finite",
         "use a share of the distance, such as 0.02"},
    };
    for (const auto& [isBroken, what, hint] : rules) {
        if (isBroken) {
            return makeError("frame-options", "", what, hint);
        }
    }
    return okStatus();
}

Outside outsideOf(const FrameOptions& frame) {
    return {frame.sky, frame.environment, frame.environmentRotation, frame.environmentIntensity};
}

gpu::FrameConstants makeConstants(const Renderer::State& state, const FrameOptions& options) {
    gpu::FrameConstants constants{};
    fillCamera(options.camera, state.scene.origin, state.size.width, state.size.height,
               sampleJitter(options.sampleIndex, options.seed), constants);
    const float coneScale = sampleConeScale(options.averagedSamples);
    constants.pixelSpread *= coneScale;
    constants.pixelWidth *= coneScale;
    constants.sampleLodBias = std::log2(coneScale);
    constants.sampleIndex = options.sampleIndex;
    constants.seed = options.seed;
    constants.averaged = options.sampleIndex - state.firstSample;
    constants.time = options.time;
    constants.mirrorRoughness = options.mirrorRoughness;
    constants.maxReflectionRoughness = options.maxReflectionRoughness;
    constants.faintWeight = options.faintWeight;
    constants.effects = options.effects & state.size.effects.all;
    constants.shadowSamples = options.shadowSamples;
    constants.occlusionSamples = options.occlusionSamples;
    constants.occlusionRadius = std::min(options.occlusionRadius, kFarDistance);
    constants.occlusionFalloff = options.occlusionFalloff ? 1 : 0;
    constants.maxInterfaces = options.maxInterfaces;
    constants.maxSampleRadiance = options.maxSampleRadiance;
    constants.binning = static_cast<std::uint32_t>(options.binning);
    constants.screenSteps = options.screenSteps;
    constants.screenThickness = options.screenThickness;
    fillOutside(outsideOf(options), constants);
    fillScene(state.scene, constants);
    constants.lastBounce = bouncesOf(state.size, options);
    constants.accumulates = (state.size.accumulates ? gpu::kPictureHasResidual : 0U) |
                            (state.size.halfPicture ? gpu::kPictureIsHalf : 0U);
    fillLists(state.frame, state.size, constants);
    setBand(state.size, 0, constants);
    return constants;
}

// A picture begins with sample 0. The first recording after drafts begins another, whatever its number.
void beginPicture(Renderer::State& state, std::uint32_t sampleIndex) {
    const bool draftsEnd = state.drafted && !state.pipelines.draft;
    if (draftsEnd || sampleIndex < state.firstSample) {
        state.firstSample = sampleIndex;
    }
    state.drafted = state.pipelines.draft;
    state.drafts += state.drafted ? 1 : 0;
}

// Lets the case that had most hits be made next. The device may be writing the counts of a frame that is in
// flight: they only decide about an order.
void orderByHits(Renderer::State& state) {
    if (state.recorded) {
        state.pipelines.background->setHits(state.hits());
    }
}

}  // namespace

std::vector<EffectName> effectsOf(const Package& package) {
    std::vector<EffectName> effects;
    for (const package::EffectInfo& effect : package.effects()) {
        effects.push_back({effect.effect, effect.kind, std::string(effect.name)});
    }
    return effects;
}

Result<std::unique_ptr<Renderer>> Renderer::create(Context& context, const Package& package, GpuScene& scene,
                                                   const RendererOptions& options) try {
    Context::State& contextState = context.state();
    GLINT_TRY_DO(checkUse(package::Passes::Frame, package, scene.state()));
    GLINT_TRY(auto choice, choosePipelines(contextState, package, options));
    if (options.pipelineStatistics && !contextState.handles.pipelineStatistics) {
        return makeError("pipeline-statistics", "", "the device was created without statistics of pipelines",
                         "create it with DeviceRequirements for them, where it has them");
    }
    const FrameSize size = frameSize(package, choice, options, textureCapacity(scene.state()));
    GLINT_TRY_DO(checkFrameSize(contextState, size));
    const std::uint32_t stretches = timerCapacity(package, size);
    GLINT_TRY(auto timer, Timer::create(contextState, stretches));
    auto state = std::make_unique<State>(contextState, scene.state(), std::move(timer));
    state->choice = choice;
    state->size = size;
    state->options = options;
    state->timerCapacity = stretches;
    state->effects = effectsOf(package);
    state->caseNames = caseNamesOf(package);
    GLINT_TRY_DO(createFrameResources(contextState, size, state->frame));
    if ((package::demandsOf(size.layers) & package::LayerInfo::kHistory) != 0) {
        GLINT_TRY(state->history, MotionHistory::create(state->scene));
    }
    const VkDescriptorSetLayout layouts[] = {state->scene.setLayout.get(), state->frame.setLayout.get()};
    GLINT_TRY(state->pipelines, createPipelines(contextState, package, choice,
                                                {options.pipelineThreads, options.pipelineStatistics},
                                                state->scene.shaderIds, {layouts}));
    enter(*state, package);
    return std::unique_ptr<Renderer>(new Renderer(std::move(state)));
}
GLINT_CATCH

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}

Renderer::~Renderer() {
    leave(*state_);
}

Status Renderer::State::choose(const Package& other, NextPackage& made) const {
    GLINT_TRY(made.choice, choosePipelines(context, other, options));
    made.size = frameSize(other, made.choice, options, textureCapacity(scene));
    return checkFrameSize(context, made.size);
}

void Renderer::State::took(const Package& taken) {
    effects = effectsOf(taken);
    rounds.clear();
    bounceLevels.reset();
}

namespace {

// Puts another environment into a set of its own, since frames in flight use the present one. They keep what
// they use until releaseLeftovers().
Status takeEnvironment(Renderer::State& state, const std::shared_ptr<const Environment::State>& environment) {
    GLINT_TRY(auto set, createFrameSet(state.context, state.size, state.frame, environment.get()));
    auto left = std::make_unique<Leftovers>();
    left->recording = state.recordings;
    state.leftovers.push_back(std::move(left));
    state.leftovers.back()->descriptors = std::exchange(state.frame.set, std::move(set)).pool;
    state.leftovers.back()->environment = std::exchange(state.environment, environment);
    return okStatus();
}

}  // namespace

// All that can fail comes before the first command is recorded.
Status Renderer::record(VkCommandBuffer commands, const FrameOptions& frame) try {
    GLINT_TRY_DO(checkFrame(frame, state_->options));
    if (state_->drawn.joinedBlases > 0 && package::infoOf(state_->choice.strategy).ownPipeline) {
        return makeError("scene-package", "",
                         "the scene has BLASes of several primitives, whose shaders this strategy can't tell "
                         "apart",
                         "call SceneEditor::record() before, which builds others in their place");
    }
    GLINT_TRY_DO(checkOutside(state_->size, outsideOf(frame)));
    if (state_->pipelines.background) {
        orderByHits(*state_);
        GLINT_TRY_DO(adoptPipelines(state_->context, state_->pipelines));
    }
    const bool switches = state_->next && joinReplacement(*state_);
    if (switches) {
        GLINT_TRY_DO(checkOutside(state_->next->size, outsideOf(frame)));
    }
    if (state_->history != nullptr) {
        GLINT_TRY_DO(state_->history->makeRoom());
    }
    if (frame.environment != nullptr && frame.environment->state() != state_->environment) {
        GLINT_TRY_DO(takeEnvironment(*state_, frame.environment->state()));
    }
    if (switches) {
        switchPackage(*state_, commands);
    }
    beginPicture(*state_, frame.sampleIndex);
    gpu::FrameConstants constants = makeConstants(*state_, frame);
    if (state_->history != nullptr) {
        state_->history->fill(constants);
    }
    prepareImages(state_->context, commands, state_->frame);
    recordFrame(*state_, commands, frame, constants);
    state_->recorded = true;
    ++state_->recordings;
    return okStatus();
}
GLINT_CATCH

Result<Renderer::Replacement> Renderer::replacePackage(const std::shared_ptr<const Package>& package) try {
    return beginReplacement(*state_, package);
}
GLINT_CATCH

Renderer::ReplacementProgress Renderer::replacementProgress() const {
    return progressOf(*state_);
}

void Renderer::withdrawPackage() {
    withdraw(*state_);
}

std::uint64_t Renderer::recordings() const {
    return state_->recordings;
}

void Renderer::finished(std::uint64_t recording) {
    releaseLeftovers(*state_, recording);
    if (state_->history != nullptr) {
        state_->history->complete(recording);
    }
    if (state_->size.paths) {
        std::array<std::uint32_t, BounceLevels::kSlots> depths{};
        const VkDeviceSize place = readbackDepth(state_->size, 0);
        std::memcpy(depths.data(), state_->frame.readback.mapped + place, sizeof(depths));
        state_->bounceLevels.completed(recording, depths);
    }
}

VkFormat Renderer::outputFormat() const {
    return state_->frame.images[gpu::kBindingAccumulated].format;
}

VkImage Renderer::output() const {
    return state_->frame.images[gpu::kBindingAccumulated].handle.get();
}

VkImageView Renderer::outputView() const {
    return state_->frame.images[gpu::kBindingAccumulated].view.get();
}

namespace {

// Renders the samples [0, sampleCount) of the frame, one after the other.
Status runSamples(Renderer& renderer, CommandRunner& runner, FrameOptions sample, std::uint32_t sampleCount,
                  const std::function<Status()>& afterSample) {
    if (sampleCount == 0) {
        return makeError("frame-options", "", "0 samples make no image", "render at least one sample");
    }
    if (sample.averagedSamples == 0) {
        sample.averagedSamples = sampleCount;
    }
    const Timing asked = sample.timing;
    for (sample.sampleIndex = 0; sample.sampleIndex < sampleCount; ++sample.sampleIndex) {
        sample.timing = sample.sampleIndex + 1 == sampleCount ? asked : Timing::Frame;
        GLINT_TRY(auto commands, runner.begin());
        GLINT_TRY_DO(renderer.record(commands, sample));
        GLINT_TRY_DO(runner.submitAndWait());
        renderer.finished(renderer.recordings());
        GLINT_TRY_DO(afterSample ? afterSample() : okStatus());
    }
    return okStatus();
}

}  // namespace

Result<LinearImage> Renderer::render(const FrameOptions& frame, std::uint32_t sampleCount,
                                     const std::function<Status()>& afterSample) try {
    GLINT_TRY(auto runner, CommandRunner::create(state_->context));
    GLINT_TRY_DO(runSamples(*this, runner, frame, sampleCount, afterSample));
    return readPicture(*state_, runner);
}
GLINT_CATCH

Status Renderer::renderSamples(const FrameOptions& frame, std::uint32_t sampleCount,
                               const std::function<Status()>& afterSample) try {
    Result<CommandRunner> runner = CommandRunner::create(state_->context);
    return runner ? runSamples(*this, *runner, frame, sampleCount, afterSample) : Status(runner.error());
}
GLINT_CATCH

Result<std::vector<PassTiming>> Renderer::timings() try { return passTimings(*state_); }
GLINT_CATCH

Renderer::PipelineProgress Renderer::pipelineProgress() const {
    const auto& background = state_->pipelines.background;
    Renderer::PipelineProgress progress = background ? background->progress() : Renderer::PipelineProgress{};
    progress.draft = state_->pipelines.draft;
    progress.drafts = state_->drafts;
    return progress;
}

void Renderer::waitForPipelines() {
    if (state_->next && state_->next->pipelines.background) {
        state_->next->pipelines.background->wait();
    }
    if (state_->pipelines.background) {
        state_->pipelines.background->wait();
    }
}

package::Tracer Renderer::tracer() const {
    return state_->choice.tracer;
}

package::Ordering Renderer::ordering() const {
    return state_->choice.ordering;
}

std::uint32_t Renderer::bands() const {
    return state_->size.bandCount();
}

Renderer::State& Renderer::state() {
    return *state_;
}

namespace {

// Names of the images by binding.
constexpr std::string_view kImageNames[] = {"surface", "radiance", "accumulated", "residual", "position"};
static_assert(std::size(kImageNames) == gpu::kFrameImageCount);

}  // namespace

std::vector<MemoryItem> Renderer::memory() const {
    std::vector<MemoryItem> items;
    const FrameResources& frame = state_->frame;
    for (std::size_t binding = 0; binding < frame.images.size(); ++binding) {
        addTo(items, std::string(kImageNames[binding]), frame.images[binding]);
    }
    for (std::size_t i = 0; i < frame.layers.size(); ++i) {
        addTo(items, "layer " + state_->size.layers[i].name, frame.layers[i]);
    }
    // Memory that buffers share with the depth image counts as the buffers' memory, and memory that they
    // share with the shadow rays of first hits as that of these.
    const auto liesIn = [](const Buffer& buffer, const auto& other) {
        return buffer.memory != nullptr && buffer.memory->lender != nullptr &&
               buffer.memory->lender == other.memory;
    };
    VkDeviceSize shared = 0;
    for (const auto& [name, buffer] : buffersOf(frame, state_->size)) {
        shared += liesIn(*buffer, frame.depth) ? buffer->bytes : 0;
    }
    if (frame.depth.handle.get() != VK_NULL_HANDLE) {
        addTo(items, {"depth", MemoryUse::Device, true, 1, frame.depth.bytes - shared});
    }
    for (const auto& [name, buffer] : buffersOf(frame, state_->size)) {
        if (liesIn(*buffer, frame.shadows)) {
            addTo(items, {name, buffer->use, false, 1, 0});
        } else {
            addTo(items, name, *buffer);
        }
    }
    if (state_->history != nullptr) {
        state_->history->addMemory(items);
    }
    for (const Buffer& table : state_->pipelines.tables) {
        addTo(items, "shader binding tables", table);
    }
    return items;
}

Renderer::Footprint Renderer::footprint() const {
    Footprint footprint;
    footprint.pipelines = static_cast<std::uint32_t>(state_->pipelines.owned.size());
    for (const MemoryItem& item : memory()) {
        (item.isImage ? footprint.images : footprint.buffers) += item.count;
        footprint.bytes += item.bytes;
    }
    footprint.allocatedBytes = (state_->history != nullptr ? state_->history->allocatedBytes() : 0) +
                               glint::allocatedBytes(state_->frame, state_->size) +
                               state_->pipelines.pool.bytes();
    return footprint;
}

Renderer::PipelineMaking Renderer::pipelineMaking() const {
    const Pipelines& pipelines = state_->pipelines;
    PipelineMaking making{pipelines.threads, pipelines.creationMs, 0};
    for (const MadePipeline& pipeline : pipelines.owned) {
        const std::optional<bool> hit = describe(pipeline).cacheHit;
        if (!hit) {
            making.cacheHits.reset();
            break;
        }
        *making.cacheHits += *hit ? 1 : 0;
    }
    return making;
}

Result<std::vector<Renderer::PipelineStatistics>> Renderer::pipelineStatistics() const try {
    if (!state_->pipelines.captureStatistics) {
        return makeError("pipeline-statistics", "",
                         "the renderer was made without statistics of its pipelines",
                         "set RendererOptions::pipelineStatistics");
    }
    std::vector<Renderer::PipelineStatistics> list;
    for (const MadePipeline& pipeline : state_->pipelines.owned) {
        GLINT_TRY(auto executables, readExecutables(state_->context, pipeline.handle->get()));
        list.push_back(describe(pipeline));
        list.back().executables = std::move(executables);
    }
    return list;
}
GLINT_CATCH

}  // namespace glint

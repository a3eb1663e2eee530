// Renderer: creation, frame constants, results.
#include "context/readback.h"
#include "context/vulkan_error.h"
#include "renderer/camera.h"
#include "renderer/renderer_choice.h"
#include "renderer/renderer_state.h"
#include "scene/instance_math.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace glint {
namespace {

// A ray of this length leaves any scene. It equals kFarDistance of shaders.
constexpr float kFarDistance = 1e18F;
// The largest number of rays a pixel and sample, to one light or for ambient occlusion.
constexpr std::uint32_t kMaxSurfaceSamples = 4096;
constexpr std::uint32_t kMaxInterfaces = 64;

Status checkEnvironment(const Renderer::State& state, const FrameOptions& frame) {
    if (state.size.environmentMap && frame.environment == nullptr) {
        return makeError("environment-missing", "",
                         "the package reads an environment map, and the frame has none",
                         "set FrameOptions::environment, or compile the package without an environment map");
    }
    if (!state.size.environmentMap && frame.environment != nullptr) {
        return makeError(
            "environment-unread", "",
            "the frame has an environment map, and the package was compiled without one",
            "compile the package for an environment map, or leave FrameOptions::environment null");
    }
    if (!std::isfinite(frame.environmentRotation) || !std::isfinite(frame.environmentIntensity) ||
        frame.environmentIntensity < 0.0F) {
        return makeError(
            "frame-options", "",
            "environmentRotation is not finite, or environmentIntensity is negative or not finite",
            "use radians, and a factor of at least 0");
    }
    return okStatus();
}

Status checkFrame(const FrameOptions& frame) {
    if (Status status = checkCamera(frame.camera); !status) {
        return status;
    }
    for (const std::array<float, 3>& radiance : {frame.sky.zenith, frame.sky.horizon, frame.sky.ground}) {
        if (!std::ranges::all_of(radiance,
                                 [](float value) { return std::isfinite(value) && value >= 0.0F; })) {
            return makeError("sky", "", "the sky's radiance is negative or not finite",
                             "give three finite numbers of at least 0");
        }
    }
    if (!std::isfinite(frame.maxReflectionRoughness) || !std::isfinite(frame.mirrorRoughness)) {
        return makeError("frame-options", "", "a limit of roughness is not finite", "use 0 to 1");
    }
    if (!std::isfinite(frame.faintWeight) || frame.faintWeight < 0.0F) {
        return makeError("frame-options", "", "faintWeight is negative or not finite", "use 0 to 1");
    }
    if (frame.shadowSamples == 0 || frame.shadowSamples > kMaxSurfaceSamples || frame.occlusionSamples == 0 ||
        frame.occlusionSamples > kMaxSurfaceSamples) {
        return makeError("frame-options", "", "shadowSamples or occlusionSamples is 0 or above the limit",
                         "use 1 to " + std::to_string(kMaxSurfaceSamples));
    }
    if (!(frame.occlusionRadius > 0.0F) ||
        (frame.occlusionFalloff && !std::isfinite(frame.occlusionRadius))) {
        return makeError(
            "frame-options", "",
            "occlusionRadius is not above 0, or infinite where occluders count less with distance",
            "use metres, or infinity without the falloff");
    }
    if (frame.maxInterfaces == 0 || frame.maxInterfaces > kMaxInterfaces) {
        return makeError("frame-options", "", "maxInterfaces is 0 or above the limit",
                         "use 1 to " + std::to_string(kMaxInterfaces));
    }
    if (!(frame.maxSampleRadiance > 0.0F)) {
        return makeError("frame-options", "", "maxSampleRadiance is not above 0",
                         "use a luminance, or infinity for no limit");
    }
    if (!std::isfinite(frame.time)) {
        return makeError("frame-options", "", "time is not finite", "use seconds");
    }
    if (!std::isfinite(frame.screenThickness) || frame.screenThickness < 0.0F) {
        return makeError("frame-options", "", "screenThickness is negative or not finite",
                         "use a share of the distance, such as 0.02");
    }
    return okStatus();
}

// Shaders turn the direction of a lookup, and the host turns the harmonics.
void fillEnvironment(const Environment::State& environment, const FrameOptions& options,
                     gpu::FrameConstants& constants) {
    const SkyHarmonics harmonics = turned(environment.harmonics, options.environmentRotation);
    for (std::size_t i = 0; i < harmonics.size(); ++i) {
        const auto channel = [&](std::size_t c) {
            return static_cast<float>(harmonics[i][c] * options.environmentIntensity);
        };
        constants.skyHarmonics[i] = {channel(0), channel(1), channel(2)};
    }
    const double turns = options.environmentRotation / (2.0 * std::numbers::pi);
    constants.environmentLevels = static_cast<float>(environment.statistics.levels);
    constants.environmentTurn = static_cast<float>(turns - std::floor(turns));
    constants.environmentScale = environment.scale * options.environmentIntensity;
}

gpu::FrameConstants makeConstants(const Renderer::State& state, const FrameOptions& options) {
    gpu::FrameConstants constants{};
    fillCamera(options.camera, state.size.width, state.size.height,
               sampleJitter(options.sampleIndex, options.seed), constants);
    const float coneScale = sampleConeScale(options.averagedSamples);
    constants.pixelSpread *= coneScale;
    constants.pixelWidth *= coneScale;
    constants.sampleLodBias = std::log2(coneScale);
    constants.sampleIndex = options.sampleIndex;
    constants.seed = options.seed;
    constants.time = options.time;
    constants.lightCount = state.scene.lightCount;
    constants.bucketCount = state.size.bucketCount;
    constants.bucketAlignment = state.size.bucketAlignment;
    constants.mirrorRoughness = options.mirrorRoughness;
    constants.maxReflectionRoughness = options.maxReflectionRoughness;
    constants.faintWeight = options.faintWeight;
    constants.effects = options.effects & state.size.effects;
    constants.countsLight = options.countsLight ? 1 : 0;
    constants.shadowSamples = options.shadowSamples;
    constants.occlusionSamples = options.occlusionSamples;
    constants.occlusionRadius = std::min(options.occlusionRadius, kFarDistance);
    constants.occlusionFalloff = options.occlusionFalloff ? 1 : 0;
    constants.maxInterfaces = options.maxInterfaces;
    constants.maxSampleRadiance = options.maxSampleRadiance;
    constants.binning = static_cast<std::uint32_t>(options.binning);
    constants.screenSteps = options.screenSteps;
    constants.screenThickness = options.screenThickness;
    constants.skyZenith = toVec3(options.sky.zenith);
    constants.skyHorizon = toVec3(options.sky.horizon);
    constants.skyGround = toVec3(options.sky.ground);
    if (options.environment != nullptr) {
        fillEnvironment(*options.environment->state(), options, constants);
    }
    constants.geometries = state.scene.geometries.address;
    constants.instances = state.scene.instances.address;
    constants.materials = state.scene.materials.address;
    constants.lights = state.scene.lights.address;
    const FrameResources& frame = state.frame;
    constants.samples = frame.samples.address;
    constants.radiance = frame.radiance.address;
    constants.rays = frame.rays.address;
    constants.hits = frame.hits.address;
    constants.packedHits = frame.hits.address;
    constants.shadows = frame.shadows.address;
    constants.shadowDispatch = frame.shadowDispatch.address;
    constants.orderedHits = frame.orderedHits.address;
    constants.visitedHits = frame.visitedHits.address;
    constants.bucketKeys = frame.bucketKeys.address;
    constants.bucketCounts = frame.bucketCounts.address;
    constants.bucketBegins = frame.bucketBegins.address;
    constants.bucketCursors = frame.bucketCursors.address;
    constants.rayDispatch = frame.rayDispatch.address;
    constants.bucketDispatch = frame.bucketDispatch.address;
    constants.counters = frame.counters.address;
    return constants;
}

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::create(Context& context, const Package& package, GpuScene& scene,
                                                   const RendererOptions& options) {
    Context::State& contextState = context.state();
    Result<PipelineChoice> choice = choosePipelines(contextState, package, options);
    if (!choice) {
        return choice.error();
    }
    if (options.pipelineStatistics && !contextState.handles.pipelineStatistics) {
        return makeError("pipeline-statistics", "", "the device was created without statistics of pipelines",
                         "create it with DeviceRequirements for them, where it has them");
    }
    const FrameSize size = frameSize(package, *choice, options);
    if (Status status = checkFrameSize(contextState, size); !status) {
        return status.error();
    }
    Result<Timer> timer = Timer::create(contextState, kMaxRounds * (kMaxFixedPasses + package.caseCount()));
    if (!timer) {
        return timer.error();
    }
    auto state = std::make_unique<State>(contextState, scene.state(), std::move(*timer));
    state->choice = *choice;
    state->size = size;
    for (const package::CaseEntry& entry : package.cases()) {
        state->caseNames.emplace_back(package.string(entry.name));
    }
    if (Status status = createFrameResources(contextState, size, state->frame); !status) {
        return status.error();
    }
    const VkDescriptorSetLayout layouts[] = {state->scene.setLayout.get(), state->frame.setLayout.get()};
    Result<Pipelines> pipelines =
        createPipelines(contextState, package, *choice, {options.pipelineThreads, options.pipelineStatistics},
                        state->scene.shaderIds, layouts);
    if (!pipelines) {
        return pipelines.error();
    }
    state->pipelines = std::move(*pipelines);
    return std::unique_ptr<Renderer>(new Renderer(std::move(state)));
}

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::~Renderer() = default;

Status Renderer::record(VkCommandBuffer commands, const FrameOptions& frame) {
    if (Status status = checkFrame(frame); !status) {
        return status;
    }
    if (Status status = checkEnvironment(*state_, frame); !status) {
        return status;
    }
    if (frame.environment != nullptr && frame.environment->state() != state_->environment) {
        bindEnvironment(state_->context, *frame.environment->state(), state_->frame);
        state_->environment = frame.environment->state();
    }
    recordFrame(*state_, commands, frame, makeConstants(*state_, frame));
    state_->recorded = true;
    return okStatus();
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
        Result<VkCommandBuffer> commands = runner.begin();
        if (!commands) {
            return commands.error();
        }
        if (Status status = renderer.record(*commands, sample); !status) {
            return status;
        }
        if (Status status = runner.submitAndWait(); !status) {
            return status;
        }
        if (Status status = afterSample ? afterSample() : okStatus(); !status) {
            return status;
        }
    }
    return okStatus();
}

}  // namespace

Result<LinearImage> Renderer::render(const FrameOptions& frame, std::uint32_t sampleCount,
                                     const std::function<Status()>& afterSample) {
    Result<CommandRunner> runner = CommandRunner::create(state_->context);
    if (!runner) {
        return runner.error();
    }
    if (Status status = runSamples(*this, *runner, frame, sampleCount, afterSample); !status) {
        return status.error();
    }
    auto pixels = readFrameImage(*state_, *runner, gpu::kBindingAccumulated);
    if (!pixels) {
        return pixels.error();
    }
    return LinearImage{state_->size.width, state_->size.height, std::move(*pixels)};
}

Status Renderer::renderSamples(const FrameOptions& frame, std::uint32_t sampleCount,
                               const std::function<Status()>& afterSample) {
    Result<CommandRunner> runner = CommandRunner::create(state_->context);
    return runner ? runSamples(*this, *runner, frame, sampleCount, afterSample) : Status(runner.error());
}

Result<std::vector<PassTiming>> Renderer::timings() {
    if (!state_->recorded) {
        return frameNotRecorded();
    }
    const auto count = static_cast<std::uint32_t>(state_->timed.size());
    Result<std::vector<double>> milliseconds = state_->timer.read(count);
    if (!milliseconds) {
        return milliseconds.error();
    }
    std::vector<PassTiming> timings;
    for (std::uint32_t i = 0; i < count; ++i) {
        const PassLabel& label = state_->timed[i];
        timings.push_back({label.name, (*milliseconds)[i], label.pass, label.shaderId});
    }
    return timings;
}

package::Tracer Renderer::tracer() const {
    return state_->choice.tracer;
}

package::Ordering Renderer::ordering() const {
    return state_->choice.ordering;
}

Renderer::State& Renderer::state() {
    return *state_;
}

}  // namespace glint

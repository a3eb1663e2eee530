#include "interop/frame.h"
#include "renderer/pipelines.h"

#include <algorithm>
#include <bit>
#include <string>

namespace glint {
namespace {

std::string modulesFor(package::Strategy strategy) {
    return "the package has no modules for the strategy " + std::string(nameOf(strategy));
}

Diagnostic notOne(const char* option) {
    return makeError("renderer-options", "",
                     std::string("RendererOptions::") + option + " is not one of its values", "choose one");
}

Result<package::Tracer> chooseTracer(const Context::State& context, const Package& package,
                                     const RendererOptions& options) {
    const std::uint32_t compiled = package::tracersOf(options.strategy, package.shape().tracers);
    if (options.tracer) {
        const package::Tracer tracer = *options.tracer;
        if (tracer != package::kTracerRayQuery && tracer != package::kTracerRayPipeline) {
            return notOne("tracer");
        }
        if ((compiled & tracer) == 0) {
            return makeError("package-tracer", "",
                             modulesFor(options.strategy) + " with the tracer " + std::string(nameOf(tracer)),
                             "compile the package with that --tracer, or render with the one that it has");
        }
        if ((context.handles.tracers & tracer) == 0) {
            return makeError("device-tracer", "",
                             "the device lacks the tracer " + std::string(nameOf(tracer)),
                             "use another device or the other tracer");
        }
        return tracer;
    }
    for (const package::Tracer tracer : package::kTracers) {
        if ((compiled & context.handles.tracers & tracer) != 0) {
            return tracer;
        }
    }
    return makeError("device-tracer", "",
                     "the device lacks the tracer that the package has for the strategy " +
                         std::string(nameOf(options.strategy)),
                     "compile the package with --tracer all");
}

// The choice follows measurements: docs/performance.md, "Ordering". On a CPU an atomic costs little more than
// the work that would save one. On a GPU hits of one bucket wait for each other in memory, unless their
// workgroup or subgroup adds them up first.
package::Ordering orderingFor(const DeviceLimits& limits, std::uint32_t bucketCount) {
    if (limits.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU) {
        return package::Ordering::GlobalAtomics;
    }
    if (bucketCount > gpu::kMaxLocalBuckets) {
        return package::Ordering::WaveBallot;
    }
    return sortsTiles(limits) ? package::Ordering::TileSort : package::Ordering::LocalHistogram;
}

bool isLocal(package::Ordering ordering) {
    return ordering == package::Ordering::LocalHistogram || ordering == package::Ordering::TileSort;
}

Status checkOrdering(const DeviceLimits& limits, package::Ordering ordering, std::uint32_t bucketCount) {
    if (ordering >= package::Ordering::Count) {
        return notOne("ordering");
    }
    const std::string name(nameOf(ordering));
    if (isLocal(ordering) && bucketCount > gpu::kMaxLocalBuckets) {
        return makeError("renderer-options", "",
                         phrase("the ordering ", name, " holds ", gpu::kMaxLocalBuckets,
                                " buckets, the package has ", bucketCount),
                         "use another ordering, or merge cases");
    }
    if (ordering == package::Ordering::TileSort && !sortsTiles(limits)) {
        return makeError("renderer-options", "",
                         phrase("the ordering ", name, " takes ", gpu::kTileSharedBytes,
                                " bytes of shared memory, workgroups of ", gpu::kTileThreads,
                                " threads and subgroups of 4 to 64 that shuffle; the device has ",
                                limits.core.maxComputeSharedMemorySize, ", ",
                                limits.core.maxComputeWorkGroupInvocations, " and ", limits.subgroupSize),
                         "use another ordering");
    }
    return okStatus();
}

}  // namespace

package::Ordering defaultOrdering(Context& context, std::uint32_t bucketCount) {
    return orderingFor(context.state().limits, bucketCount);
}

Result<PipelineChoice> choosePipelines(const Context::State& context, const Package& package,
                                       const RendererOptions& options) {
    const std::uint32_t strategy = options.strategy;
    if (!std::has_single_bit(strategy) || strategy > package::allStrategies()) {
        return notOne("strategy");
    }
    if (!package.supports(options.strategy)) {
        return makeError("package-strategy", "", modulesFor(options.strategy),
                         "compile the package with that --strategy, or render with the one that it has");
    }
    GLINT_TRY(auto tracer, chooseTracer(context, package, options));
    const std::uint32_t demands = package::demandsOf(package.layers());
    if ((demands & package::LayerInfo::kQueries) != 0 && tracer != package::kTracerRayQuery) {
        return makeError("package-tracer", "",
                         "the package's layer candidates counts what ray queries test, and the tracer is " +
                             std::string(nameOf(tracer)),
                         "use the tracer ray-query, with a strategy that has it, or leave out the layer");
    }
    if ((demands & package::LayerInfo::kClock) != 0 && !context.handles.shaderClock) {
        return makeError(
            "device-layers", "",
            "the package's layer clocks reads a clock, which the device does not allow or was not "
            "created for",
            "create it with VK_KHR_shader_clock and set DeviceHandles::shaderClock, or leave out the "
            "layer");
    }
    const std::uint32_t compiledBounces = package.shape().maxBounces;
    if (options.bounces == 0 || options.bounces > compiledBounces) {
        return makeError(
            "package-bounces", "",
            phrase("paths of ", options.bounces,
                   " bounces are asked for, and the package was compiled for 1 to ", compiledBounces),
            "compile the package with more --bounces, or ask for fewer");
    }
    if (options.backgroundPipelines && !package.shape().fallback) {
        return makeError(
            "package-fallback", "",
            "pipelines are to be made in the background, and the package has no fallback to draw "
            "with meanwhile",
            "compile the package with --fallback, or make all pipelines at once");
    }
    PipelineChoice choice;
    choice.background = options.backgroundPipelines;
    choice.draft = options.backgroundPipelines && options.draft && package.passes() == package::Passes::Frame;
    choice.bounces = options.bounces;
    choice.strategy = options.strategy;
    choice.tracer = tracer;
    choice.ordering = options.ordering.value_or(orderingFor(context.limits, package.bucketCount()));
    choice.checksOrder = options.checkOrder;
    choice.batchEffects = options.batchEffects;
    choice.halfPicture = hasHalfPicture(package, options);
    choice.countsLight = options.countsLight;
    // Bands cost a GPU with memory of its own a fifth to a half of its time (docs/memory.md).
    const bool isDiscrete = context.limits.deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    choice.bands = options.bands == 0 && isDiscrete ? 1 : options.bands;
    GLINT_TRY_DO(checkOrdering(context.limits, choice.ordering, package.bucketCount()));
    return choice;
}

namespace {

// The most dispatches of cases that bands may bring to first hits.
constexpr std::uint32_t kCasesOfBands = 256;
// The fewest pixels of a band, unless a number of bands is wanted: small bands leave a GPU idle.
constexpr std::uint64_t kLeastPixelsOfBand = std::uint64_t{1} << 18;
// The bytes for each pixel of the frame within which buffers of bands stay, and those of each effect with
// rays beyond the first: with the images of a frame that does not accumulate, 64 and 16 bytes.
constexpr std::uint64_t kBufferBytes = 40;
constexpr std::uint64_t kBufferBytesOfEffect = 16;

std::uint32_t rowsOf(const FrameSize& size, std::uint64_t bands) {
    constexpr std::uint32_t kTile = gpu::kPixelGroupSize;
    const std::uint64_t rows = (size.height + bands - 1) / bands;
    const auto whole = static_cast<std::uint32_t>((rows + kTile - 1) / kTile * kTile);
    return whole < size.height ? whole : 0;
}

// Returns the fewest bands whose buffers are small enough.
std::uint64_t chooseBands(FrameSize size) {
    const std::uint64_t pixels = std::uint64_t{size.width} * size.height;
    const std::uint64_t effects = std::max(size.sampleCount, 1U) - 1;
    const VkDeviceSize most = imageBytes(size) + (kBufferBytes + kBufferBytesOfEffect * effects) * pixels;
    const std::uint64_t ofCases = std::max(kCasesOfBands / size.bucketCount, 1U);
    const std::uint64_t last = std::min(pixels / kLeastPixelsOfBand, ofCases);
    std::uint64_t bands = std::min((pixels + kPixelsOfBand - 1) / kPixelsOfBand, ofCases);
    for (size.bandRows = rowsOf(size, bands); bands < last && frameBytes(size) > most;) {
        ++bands;
        size.bandRows = rowsOf(size, bands);
    }
    return bands;
}

}  // namespace

std::uint32_t chooseBandRows(const FrameSize& size, std::uint32_t bands) {
    const bool isEmpty = size.width == 0 || size.height == 0;  // an error that checkFrameSize() reports
    const bool hasNothing = size.sampleCount == 0 && size.firstShadowBytes == 0;
    if (isEmpty || size.hostRays || hasNothing || size.marchesScreen) {
        return 0;
    }
    return rowsOf(size, bands > 0 ? bands : chooseBands(size));
}

std::uint32_t firstShadowBytes(const Package& package) {
    // shaders/effects/shadow/shadow.glsl: WaitingShadow, with the light past glass where both are known.
    const bool splitsGlass =
        package.emission() != nullptr && package.shadowThrough() == package::ShadowThrough::Glass;
    return !package.shape().defersFirstShadows() ? 0 : splitsGlass ? 40 : 28;
}

bool hasHalfPicture(const Package& package, const RendererOptions& options) {
    // Modules that write such layers have both formats of images, which must stay two types.
    const bool hasWideLayers = std::ranges::any_of(package.layers(), [](const package::PackageLayer& layer) {
        return layer.info->format == package::LayerInfo::Format::Float4 ||
               layer.info->format == package::LayerInfo::Format::Half4;
    });
    const bool marches = options.screenMarch && package.shape().effects.screenStarts != 0;
    return options.picture == RendererOptions::PictureFormat::Half && !options.accumulate && !marches &&
           !hasWideLayers;
}

FrameSize frameSize(const Package& package, const PipelineChoice& choice, const RendererOptions& options,
                    std::uint32_t textures) {
    FrameSize size;
    size.width = options.width;
    size.height = options.height;
    size.bucketCount = package.bucketCount();
    size.effects = package.shape().effects;
    size.hostRays = package.passes() == package::Passes::Steps;
    size.sampleCount = size.hostRays ? 1 : package::effectSlots(size.effects);
    size.batchCount = choice.batchEffects ? size.sampleCount : std::min(size.sampleCount, 1U);
    size.paths = package::hasPaths(package.shape());
    size.emissiveLights = package.emission() != nullptr;
    size.skyLight = package.skyLight();
    size.sizedLights = package.sizedLights();
    size.bounces = size.paths ? choice.bounces : 1;
    size.ordered = size.sampleCount > 0 && (choice.strategy & package::orderedStrategies()) != 0;
    size.checksOrder = size.ordered && choice.checksOrder;
    size.bucketAlignment =
        (choice.strategy & package::strategiesThat(&package::StrategyInfo::fillsWorkgroups)) != 0
            ? gpu::kRayGroupSize
            : 1;
    size.packedSamples = package.sampleRecord() == package::SampleRecordFormat::Packed;
    size.hitBytes = package.hitsInSamples()                                   ? 0
                    : package.hitRecord() == package::HitRecordFormat::Packed ? sizeof(gpu::PackedHitRecord)
                                                                              : sizeof(gpu::HitRecord);
    size.keyBytes = keyBytesOf(size.bucketCount);
    size.environmentMap = package.environmentMap();
    size.textureLevels = package.textureLevels() ? textures : 0;
    size.deferredShadows =
        size.effects.lights != 0 && package.shape().shadows == package::ShadowPlacement::Deferred;
    size.lightSamples = package.lightSamples();
    size.firstShadowRays = package.shape().firstShadowRays;
    size.firstShadowBytes = firstShadowBytes(package);
    size.rayPipeline = choice.tracer == package::kTracerRayPipeline;
    size.layers.assign(package.layers().begin(), package.layers().end());
    size.layerRays = (package::demandsOf(size.layers) & package::LayerInfo::kRays) != 0;
    size.layerBounces = package::layerBounces(size.layers);
    size.layerWalks = size.sizedLights && package::showWalkedLight(size.layers, size.effects.walks);
    size.accumulates = options.accumulate;
    size.marchesScreen = options.screenMarch && size.effects.screenStarts != 0;
    size.halfPicture = choice.halfPicture;
    size.bandRows = chooseBandRows(size, choice.bands);
    return size;
}

}  // namespace glint

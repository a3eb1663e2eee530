#include "cli/render/report.h"

#include "base/fields.h"
#include "base/lists.h"
#include "emit/package/manifest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace glint::cli {

namespace {

// Describes the added light in one line.
std::string sunText(const RenderReport& report) {
    const std::string lux = fmt::format("{:.3g} lux", report.sun->light.intensity[0]);
    return lux + (report.sun->automatic ? ", added because the scene has no light (--no-sun leaves it out)"
                                        : " (--sun)");
}

constexpr std::string_view nameOf(GpuScene::MotionStatistics::TopLevel action) {
    switch (action) {
        case GpuScene::MotionStatistics::TopLevel::Updated:
            return "updated";
        case GpuScene::MotionStatistics::TopLevel::Rebuilt:
            return "rebuilt";
        default:
            return "kept";
    }
}

const char* nameOf(MemoryUse use) {
    switch (use) {
        case MemoryUse::Upload:
            return "upload";
        case MemoryUse::Shared:
            return "shared";
        case MemoryUse::Readback:
            return "readback";
        default:
            return "device";
    }
}

const char* kindOf(const MemoryItem& item) {
    return item.isImage ? "image" : "buffer";
}

std::string tableOf(const std::vector<FrameReport>& frames) {
    Rows rows{{"frame", "seconds", "refitted", "rebuilt", "TLAS", "pose ms", "deform", "BLAS", "TLAS",
               "render", "passes"}};
    const auto number = [](double value) { return fmt::format("{:.3f}", value); };
    for (const FrameReport& frame : frames) {
        const GpuScene::MotionStatistics& motion = frame.motion;
        rows.push_back({std::to_string(frame.frame), number(frame.seconds), std::to_string(motion.refits),
                        std::to_string(motion.rebuilds), std::string(nameOf(motion.topLevel)),
                        number(frame.poseMs), number(motion.deformMs), number(motion.blasMs),
                        number(motion.tlasMs), number(frame.renderMs), number(frame.deviceMs)});
    }
    return formatTable(rows);
}

// Returns the picture, or the first and the last of a sequence.
std::string filesOf(const RenderReport& report) {
    const std::vector<FrameReport>& frames = report.frames;
    if (frames.empty()) {
        return report.image;
    }
    const std::string& first = frames.front().image;
    return frames.size() == 1 ? first : fmt::format("{} to {}", first, frames.back().image);
}

// A gate of an effect, with the number of rays that it kept.
struct Gate {
    const char* name;
    std::uint32_t Renderer::EffectCounters::*count;
};
constexpr Gate kGates[] = {
    {"sky", &Renderer::EffectCounters::skippedSky},       {"unlit", &Renderer::EffectCounters::skippedUnlit},
    {"rough", &Renderer::EffectCounters::skippedRough},   {"black", &Renderer::EffectCounters::skippedBlack},
    {"absent", &Renderer::EffectCounters::skippedAbsent}, {"faint", &Renderer::EffectCounters::skippedFaint},
    {"facing", &Renderer::EffectCounters::skippedFacing}, {"range", &Renderer::EffectCounters::skippedRange},
    {"cone", &Renderer::EffectCounters::skippedCone},
};

using SkippedRays = std::pair<std::string_view, std::uint32_t>;
std::vector<SkippedRays> skippedOf(const Renderer::EffectCounters& effect) {
    return base::mapped<SkippedRays>(
        kGates, [&](const Gate& gate) { return SkippedRays(gate.name, effect.*gate.count); });
}

std::string effectText(const Renderer::EffectCounters& effect) {
    std::string text = fmt::format("{} rays: {} hit, {} missed", effect.rays, effect.hits, effect.misses);
    if (effect.segments > 0) {
        text += fmt::format("; {} on their way", effect.segments);
    }
    if (effect.screenHits > 0) {
        text += fmt::format("; {} found in screen space", effect.screenHits);
    }
    const auto filled =
        std::ranges::count_if(effect.bucketCounts, [](std::uint32_t count) { return count > 0; });
    if (!effect.bucketCounts.empty()) {
        text += fmt::format("; {} of {} buckets", filled, effect.bucketCounts.size());
    }
    std::string gates;
    for (const Gate& gate : kGates) {
        if (effect.*gate.count > 0) {
            gates += fmt::format("{}{} {}", gates.empty() ? "" : ", ", effect.*gate.count, gate.name);
        }
    }
    return gates.empty() ? text : fmt::format("{} (no ray: {})", text, gates);
}

std::string titleOf(const PassTiming& pass, const RenderReport& report, Detail detail) {
    return isOfCase(pass.pass) ? (pass.pass == Pass::FirstCase ? "first " : "shade ") +
                                     shaderTitle(pass.shaderId, report.caseNames.at(pass.shaderId), detail)
                               : pass.name;
}

// Describes the choice in one line.
std::string toText(const session::SkyChoice& choice) {
    const double mean = session::meanIlluminance(choice.sky()) / std::numbers::pi;
    const std::string what =
        fmt::format("{:.3g} cd/m² on average, {:.3g} times the default", mean, choice.scale);
    if (!choice.automatic) {
        return what + " (--sky)";
    }
    return choice.lights ? fmt::format("{}, for lights of {:.3g} lux", what, *choice.lights) : what;
}

std::string toText(const TextureReport& textures) {
    const auto formats = base::mapped<std::string>(
        textures.formats, [](const auto& one) { return fmt::format("{} {}", one.second, one.first); });
    std::string text =
        fmt::format("{}: {}, {:.2f} bytes a texel", fmt::join(formats, ", "), formatBytes(textures.bytes),
                    static_cast<double>(textures.bytes) /
                        static_cast<double>(std::max<std::uint64_t>(textures.texels, 1)));
    if (!textures.levels.empty()) {
        const auto levels = base::mapped<std::string>(
            textures.levels, [](const auto& level) { return level ? std::to_string(*level) : "-"; });
        text += fmt::format("; finest levels read: {}", fmt::join(levels, " "));
    }
    return text;
}

}  // namespace

void RenderReport::addHits(const Renderer::Counters& sample) {
    // The first bucket is for misses.
    hits.resize(std::max(hits.size(), sample.bucketCounts.empty() ? 0 : sample.bucketCounts.size() - 1));
    for (std::size_t bucket = 1; bucket < sample.bucketCounts.size(); ++bucket) {
        hits[bucket - 1] += sample.bucketCounts[bucket];
    }
}

Status checkOrder(const RenderReport& report) {
    const std::uint32_t errors = report.counters.orderErrors;
    if (errors == 0) {
        return okStatus();
    }
    return makeError(
        "order-check", report.scene,
        fmt::format("{} hits were lost, doubled or misplaced when they were ordered by shader", errors),
        "this is a defect of Glint or of the driver: please report it, and try another --ordering");
}

}  // namespace glint::cli

namespace glint::session {

static base::Fields fieldsOf(const SkyChoice*) {
    using T = SkyChoice;
    return {base::output<&T::scale>("scale", "Factor of the default sky's radiance."),
            base::output<&T::automatic>("automatic", "Whether the lights chose the factor."),
            base::output("luminance", "Mean luminance over all directions, in cd/m².",
                         [](const T& sky) { return meanIlluminance(sky.sky()) / std::numbers::pi; }),
            base::output<&T::lights>("lightIlluminance",
                                     "Log-average of the lights' illuminance in lux; null without lights.")};
}

}  // namespace glint::session

namespace glint {

static base::Fields fieldsOf(const PassTiming*) {
    using T = PassTiming;
    return {base::output<&T::name>("name", "Name of the pass."),
            base::output("shaderId", "The case, for a pass that shades one; null for other passes.",
                         [](const T& pass) {
                             return isOfCase(pass.pass) ? std::optional(pass.shaderId) : std::nullopt;
                         }),
            base::output<&T::milliseconds>("milliseconds", "Device time of the pass.")};
}

static base::Fields fieldsOf(const MemoryItem*) {
    using T = MemoryItem;
    using base::output;
    return {output<&T::name>("name", "What it holds."),
            output<cli::kindOf>("kind", "Kind of resource.", {.names = {"image", "buffer"}}),
            output("use", "Whether only the device uses it, or the host writes or reads it.",
                   [](const T& item) { return cli::nameOf(item.use); },
                   {.names = {"device", "upload", "shared", "readback"}}),
            output<&T::count>("count", "Number of resources of this name."),
            output<&T::bytes>("bytes", "Size of all of them.")};
}

static base::Fields fieldsOf(const Renderer::EffectCounters*) {
    using T = Renderer::EffectCounters;
    using base::output;
    return {output<&T::name>("name", "Name of the effect."),
            output<&T::rays>("rays",
                             "Rays traced to their end; those to lights and occluders with --stats only."),
            output<&T::hits>("hits", "Rays that hit something."),
            output<&T::misses>("misses", "Rays that met nothing."),
            output<&T::segments>("segments", "Rays from one interface to the next, for refraction."),
            output<&T::screenHits>("screenHits", "Hits that were found in screen space instead of by a ray."),
            output<&T::waited>("waited", "Those of the rays that waited in memory (--first-shadows)."),
            output<cli::skippedOf>(
                "skipped",
                "Rays that were not sent, by pixel, or by light and pixel: no surface (sky), unlit, "
                "above --max-roughness (rough), no light or into the surface (black), no such lobe "
                "(absent), below --skip-below (faint), and surfaces that face away from a light "
                "(facing), beyond its range or outside its cone."),
            output<&T::bucketCounts>("buckets",
                                     "Misses, then hits by shader ID; empty if not ordered by effect.")};
}

}  // namespace glint

namespace glint::cli {

using base::output;

// --- What is on the device ---

static base::Fields fieldsOf(const PipelineCacheReport*) {
    using T = PipelineCacheReport;
    return {output<&T::file>("file", "The cache's file for this device and driver."),
            output<&T::loadedBytes>("loadedBytes", "Size of the file before; 0 if there was nothing usable."),
            output<&T::savedBytes>("savedBytes", "Size of the file after; 0 if it could not be written."),
            output<&T::hits>("hits", "Pipelines found in it; null if the driver does not say.")};
}

// Returns "8 in 12.3 ms by 4 threads; cache of 1.2 MiB, 8 found in it".
static std::string toText(const PipelineReport& report) {
    const Renderer::PipelineMaking& making = report.making;
    std::string text =
        fmt::format("{} in {} by {} thread{}", report.count, formatMilliseconds(making.milliseconds),
                    making.threads, making.threads == 1 ? "" : "s");
    if (report.cache) {
        text += fmt::format("; cache of {}", formatBytes(report.cache->loadedBytes));
        if (making.cacheHits) {
            text += fmt::format(", {} found in it", *making.cacheHits);
        }
    }
    return text;
}

static base::Fields fieldsOf(const StartReport*) {
    using T = StartReport;
    return {
        output<&T::deviceMs>("deviceMs", "Time of making instance, device and pipeline cache."),
        output<&T::texturesMs>("texturesMs", "Time of reading, transcoding and compressing images."),
        output<&T::uploadMs>("uploadMs", "Time of uploading the scene and building acceleration structures."),
        output<&T::rendererMs>("rendererMs", "Time of making buffers, images and pipelines."),
        output<&T::firstSampleMs>("firstSampleMs", "Time of the first sample until it is complete."),
        output<&T::totalMs>("totalMs", "Sum of these times.")};
}

static std::string toText(const StartReport& start) {
    return fmt::format(
        "after {}: device {:.3f}, textures {:.3f}, scene {:.3f}, renderer {:.3f}, sample {:.3f}",
        formatMilliseconds(start.totalMs()), start.deviceMs, start.texturesMs, start.uploadMs,
        start.rendererMs, start.firstSampleMs);
}

std::string tableOf(std::span<const Renderer::PipelineStatistics> pipelines) {
    Rows rows{{"pipeline", "executable", "subgroup"}};
    for (const inspect::FactInfo& info : inspect::factTable()) {
        rows.front().emplace_back(info.column);
    }
    for (const Renderer::PipelineStatistics& pipeline : pipelines) {
        for (const Renderer::PipelineStatistics::Executable& executable : pipeline.executables) {
            const inspect::PipelineFacts facts = inspect::factsOf(executable);
            std::vector<std::string>& row = rows.emplace_back();
            row = {pipeline.name, executable.name,
                   executable.subgroupSize > 0 ? std::to_string(executable.subgroupSize) : "-"};
            for (const inspect::FactInfo& info : inspect::factTable()) {
                row.push_back(factText(info, facts));
            }
        }
    }
    return formatTable(rows, Detail::Whole);
}

std::string factText(const inspect::FactInfo& info, const inspect::PipelineFacts& facts) {
    const std::optional<double>& value = facts.*info.member;
    if (!value) {
        return "-";
    }
    return info.isLeast ? fmt::format("{:.0f} %", 100.0 * *value) : fmt::format("{}", std::round(*value));
}

static std::uint64_t bytesOf(const std::vector<MemoryItem>& items) {
    return base::sumOf<std::uint64_t>(items, &MemoryItem::bytes);
}

base::Fields fieldsOf(const MemoryReport*) {
    using T = MemoryReport;
    return {
        output<&T::frame>("frame", "Every image and buffer of the footprint."),
        output("frameBytes", "Sum of these sizes.", [](const T& memory) { return bytesOf(memory.frame); }),
        output<&T::frameAllocatedBytes>("frameAllocatedBytes", "Size of the allocations that hold them."),
        output<&T::bands>("bands",
                          "Bands of rows that are lit one after the other in this memory (--bands)."),
        output<&T::scene>("scene", "Images and buffers of the scene."),
        output("sceneBytes", "Sum of these sizes.", [](const T& memory) { return bytesOf(memory.scene); }),
        output<&T::sceneAllocatedBytes>("sceneAllocatedBytes", "Size of the allocations that hold them."),
        output("bytes", "Size of frame and scene.",
               [](const T& memory) { return bytesOf(memory.frame) + bytesOf(memory.scene); })};
}

std::string toText(const MemoryReport& memory) {
    Rows rows{{"memory", "of", "kind", "use", "bytes"}};
    for (const auto& [owner, items] :
         {std::pair("frame", &memory.frame), std::pair("scene", &memory.scene)}) {
        for (const MemoryItem& item : *items) {
            const std::string many = item.count > 1 ? std::to_string(item.count) + " " : "";
            rows.push_back({item.name, owner, many + kindOf(item) + (item.count > 1 ? "s" : ""),
                            nameOf(item.use), std::to_string(item.bytes)});
        }
    }
    rows.push_back({"all", "", "", "", std::to_string(bytesOf(memory.frame) + bytesOf(memory.scene))});
    return formatTable(rows);
}

// --- The picture ---

static base::Fields fieldsOf(const EnvironmentReport*) {
    using T = EnvironmentReport;
    using Statistics = Environment::Statistics;
    return {output<&T::file>("file", "Path as given on the command line."),
            output<&T::statistics, &Statistics::width>("width", "Width of the filtered map."),
            output<&T::statistics, &Statistics::height>("height", "Height of the filtered map."),
            output<&T::statistics, &Statistics::levels>("levels", "Number of levels of roughness."),
            output<&T::statistics, &Statistics::halfFloat>("halfFloat", "Whether 16 bits a channel hold it."),
            output<&T::statistics, &Statistics::filterMs>("filterMs", "Wall-clock time of filtering.")};
}

static base::Fields fieldsOf(const FrameReport*) {
    using T = FrameReport;
    using Motion = GpuScene::MotionStatistics;
    return {output<&T::frame>("frame", "Number of the picture."),
            output<&T::seconds>("seconds", "Time of the animation in seconds."),
            output<&T::image>("image", "File of the picture."),
            output<&T::edits>("edits", "Edits that were made before it, since the picture before."),
            output<&T::motion, &Motion::deformed>("deformed", "Instances whose vertices moved."),
            output<&T::motion, &Motion::refits>("refits", "Number of BLASes that were refitted."),
            output<&T::motion, &Motion::rebuilds>("rebuilds", "Number of BLASes that were rebuilt."),
            output("topLevel", "What was done with the TLAS.",
                   [](const T& it) { return nameOf(it.motion.topLevel); },
                   {.names = {"kept", "updated", "rebuilt"}}),
            output<&T::poseMs>("poseMs", "Wall-clock time of computing nodes, joints and weights."),
            output<&T::updateMs>("updateMs", "Wall-clock time of updating the scene on the device."),
            output<&T::motion, &Motion::deformMs>("deformMs", "Device time of deforming vertices."),
            output<&T::motion, &Motion::blasMs>("blasMs", "Device time of updating BLASes."),
            output<&T::motion, &Motion::tlasMs>("tlasMs", "Device time of updating the TLAS."),
            output<&T::renderMs>("renderMs", "Wall-clock time of all samples."),
            output<&T::deviceMs>("deviceMs", "Device time of the passes of the last sample.")};
}

static base::Fields fieldsOf(const TextureReport*) {
    using T = TextureReport;
    return {output<&T::images>("images", "Number of images."),
            output<&T::formats>("formats", "How many images have a format, by its name."),
            output<&T::texels>("texels", "Texels of the first levels."),
            output<&T::bytes>("bytes", "Size of all levels."),
            output<&T::found>("found", "Number of compressed images that came from the cache."),
            output<&T::levels>("levels",
                               "With --texture-levels: the finest level read of each texture, or null.")};
}

static base::Fields fieldsOf(const RenderReport::Sun*) {
    using T = RenderReport::Sun;
    return {output<&T::light, &LightView::intensity>("illuminance", "Red, green and blue, in lux."),
            output<&T::light, &LightView::direction>("direction", "In which its light travels."),
            output<&T::automatic>("automatic", "Whether it was added because the scene has no light.")};
}

namespace {

std::vector<base::Field> sceneStatistics() {
    using S = GpuScene::Statistics;
    constexpr auto kAt = &RenderReport::sceneStatistics;
    return {
        output<kAt, &S::triangles>("triangles", "Number of triangles of all instances."),
        output<kAt, &S::geometries>("geometries", "Number of geometries of all instances."),
        output<kAt, &S::instances>("instances", "Number of instances in the acceleration structure."),
        output<kAt, &S::blasCount>("blasCount", "Number of bottom-level structures."),
        output<kAt, &S::blasBytes>("blasBytes", "Size of the bottom-level structures after compaction."),
        output<kAt, &S::blasUncompactedBytes>("blasUncompactedBytes", "Their size before compaction."),
        output<kAt, &S::narrowedTextures>("narrowedTextures", "16-bit textures read with 8 bits."),
        output<kAt, &S::maskedTriangles>("maskedTriangles", "Triangles whose alpha rays would test."),
        output<kAt, &S::provedOpaque>("provedOpaque", "Those that are proved opaque."),
        output<kAt, &S::provedTransparent>("provedTransparent", "Those that are proved transparent."),
        output<kAt, &S::micromaps>("micromaps", "Opacity micromaps of the others."),
        output<kAt, &S::micromapBytes>("micromapBytes", "Their bytes on the device."),
        output<kAt, &S::opacityMs>("opacityMs", "Wall-clock time of the proofs and of the micromaps."),
        output<kAt, &S::orderMs>("orderMs", "Wall-clock time of ordering triangles."),
        output<kAt, &S::blasBuildMs>("blasBuildMs", "Device time of building the bottom-level structures."),
        output<kAt, &S::tlasBuildMs>("tlasBuildMs", "Device time of building the top-level structure.")};
}

std::vector<base::Field> counters() {
    using C = Renderer::Counters;
    constexpr auto kAt = &RenderReport::counters;
    return {
        output<kAt, &C::rays>("rays", "Number of rays of all effects whose hits are shaded."),
        output<kAt, &C::raysOfBounces>("raysOfBounces", "Rays by bounce, those of the effects first."),
        output<kAt, &C::shadowRays>("shadowRays", "Number of deferred shadow rays of hits."),
        output<kAt, &C::shadowRounds>(
            "shadowRounds", "Rounds in which the shadow rays of first hits were traced; 0 if none waits."),
        output<kAt, &C::orderErrors>("orderErrors", "Hits lost, doubled or misplaced."),
        output<kAt, &C::unknownShader>("unknownShader", "Number of hits whose shader no case has."),
        output<kAt, &C::alphaTests>("alphaTests", "Candidates of rays whose alpha was tested."),
        output<kAt, &C::nonFinite>("nonFinite", "Samples that were NaN or infinite."),
        output<kAt, &C::pixelCounts>(
            "pixels", "Pixels without a surface, then pixels by the shader ID of what they see."),
        output<kAt, &C::bucketCounts>("buckets", "Misses, then hits by shader ID.")};
}

}  // namespace

base::Fields fieldsOf(const RenderReport*) {
    using T = RenderReport;
    using Pipelines = PipelineReport;
    using Footprint = Renderer::Footprint;
    return {
        output<&T::scene>("scene", "Path as given on the command line."),
        output("sceneInFile", "The scene that was read (--scene); null if there are none.",
               [](const T& report) { return compiler::orNone(report.sceneInFile); }),
        output<&T::image>("image", "Path as given on the command line."),
        output<&T::device>("device", "Name of the GPU."),
        output<&T::driver>("driver", "Name of its driver."),
        output<&T::strategy>("strategy", "How hits were shaded.", {.names = compiler::strategyWords()}),
        output<&T::strategyChoice>("strategyChoice", "How --strategy auto chose; null without it."),
        output<&T::tracer>("tracer", "The tracer.", {.names = base::wordsFor<package::Tracer>()}),
        output<&T::ordering>("ordering", "How hits were ordered; null where the strategy orders none."),
        output<&T::merge>("merge", "Policy of the package that was compiled; null with --package."),
        output<&T::alpha>("alpha", "What rays do with the alpha of what they hit.",
                          {.names = base::wordsFor<package::AlphaPolicy>()}),
        output<&T::width>("width", "Width in pixels."),
        output<&T::height>("height", "Height in pixels."),
        output<&T::samples>("spp", "Samples of each pixel."),
        output<&T::seed>("seed", "Seed of the random numbers."),
        output<&T::camera>("camera", "Name or number of the camera, or auto."),
        output<&T::exposure>("exposure", "Exposure in stops."),
        output<&T::exposureAutomatic>("exposureAutomatic", "Whether the first picture chose the exposure."),
        output<&T::sky>("sky", "The sky, a gradient; null with --environment."),
        output<&T::sun>("sun", "The directional light that --sun adds; null where there is none."),
        output<&T::cases>("cases", "Number of shaders."),
        output<&T::compileMs>("compileMs", "Time of compilation; null with --package."),
        output<&T::environment>("environment", "The environment map; null without --environment."),
        base::group("sceneStatistics", "Statistics of the scene on the device.", sceneStatistics()),
        output<&T::textures>("textures", "The images of the scene as the device reads them."),
        output<&T::pipelines, &Pipelines::making, &Renderer::PipelineMaking::milliseconds>(
            "pipelineCreationMs", "Wall-clock time of the driver's compilation."),
        output<&T::pipelines, &Pipelines::making, &Renderer::PipelineMaking::threads>(
            "pipelineThreads", "Number of threads that created the pipelines."),
        output<&T::pipelines, &Pipelines::cache>("pipelineCache",
                                                 "The pipeline cache; null if none is kept."),
        output<&T::pipelines, &Pipelines::statistics>(
            "pipelineStatistics",
            "The report of --pipeline-statistics; null without it, or if the device has none."),
        output<&T::start>("start", "Wall-clock time to the first sample, without compiling."),
        output<&T::renderMs>("renderMs", "Wall-clock time of all samples and of reading back."),
        output<&T::frames>("frames", "Pictures of --frames. `passes` and `counters` are of the last."),
        output<&T::passes>("passes", "Passes of the last sample, in order."),
        base::group("counters", "Counters of the last sample.", counters()),
        output<&T::view>("view", "The debug picture of the last frame; null without --view."),
        output<&T::counters, &Renderer::Counters::effects>(
            "effects", "The package's effects in a fixed order, with what each did in the last sample."),
        base::group(
            "footprint", "Resources that the renderer holds for a frame.",
            {output<&T::footprint, &Footprint::pipelines>("pipelines", "Number of pipelines."),
             output<&T::footprint, &Footprint::images>("images", "Number of images, including depth."),
             output<&T::footprint, &Footprint::buffers>("buffers", "Number of buffers."),
             output<&T::footprint, &Footprint::bytes>("bytes", "Memory of images and buffers.")}),
        output<&T::memory>("memory", "Memory on the device, by name."),
        output<&T::traffic>("traffic", "The bytes that the last sample's passes moved between each other.")};
}

TextureReport textureReport(std::span<const ImageView> images) {
    TextureReport report;
    for (const ImageView& image : images) {
        const bool isBlitted = !isBlockFormat(image.format);
        ++report.images;
        ++report.formats[infoOf(image.format).name];
        report.texels += std::uint64_t{image.width} * image.height * image.layers;
        report.bytes += image.byteCount(isBlitted ? image.mostLevels() : image.levels);
    }
    return report;
}

std::string toText(const RenderReport& report, Detail detail) {
    const GpuScene::Statistics& scene = report.sceneStatistics;
    const Renderer::Counters& counters = report.counters;
    const double bytesOfPixel = static_cast<double>(report.footprint.bytes) /
                                std::max(static_cast<double>(report.width) * report.height, 1.0);
    Rows rows{
        {"image",
         fmt::format("{}, {} x {}, {} spp", filesOf(report), report.width, report.height, report.samples)},
        {"device", fmt::format("{} ({})", report.device, report.driver)},
        {"strategy",
         fmt::format("{}{}, {}, {} case{}", report.strategy, report.strategyChoice ? " (auto)" : "",
                     report.tracer, report.cases, report.cases == 1 ? "" : "s")},
        {"camera", report.camera},
        {"exposure", fmt::format("{:+.2f} EV, {}", report.exposure,
                                 report.exposureAutomatic ? "brings surfaces to mid-grey" : "as asked for")},
        {"scene", fmt::format("{} triangles, {} instances", scene.triangles, scene.instances)},
        {"BLAS",
         fmt::format("{} in {}", formatBytes(scene.blasBytes), formatMilliseconds(scene.blasBuildMs))}};
    if (report.sky) {
        rows.insert(rows.end() - 3, {"sky", toText(*report.sky)});
    }
    if (report.sun) {
        rows.insert(rows.end() - 3, {"sun", sunText(report)});
    }
    if (report.environment) {
        const Environment::Statistics& map = report.environment->statistics;
        rows.push_back(
            {"environment", fmt::format("{}, {} x {}, {} levels in {}", report.environment->file, map.width,
                                        map.height, map.levels, formatMilliseconds(map.filterMs))});
    }
    if (report.compileMs) {
        rows.push_back({"compile", formatMilliseconds(*report.compileMs)});
    }
    rows.push_back({"pipelines", toText(report.pipelines)});
    rows.push_back({"first sample", toText(report.start)});
    rows.push_back({"render", formatMilliseconds(report.renderMs)});
    for (const Renderer::EffectCounters& effect : counters.effects) {
        if (!report.countsLight && effect.kind != package::EffectInfo::Kind::Rays) {
            continue;  // not counted
        }
        rows.push_back({effect.name, effectText(effect)});
    }
    if (counters.raysOfBounces.size() > 1) {
        rows.push_back({"rays by bounce", fmt::format("{}", fmt::join(counters.raysOfBounces, ", "))});
    }
    if (counters.shadowRounds > 1) {
        rows.push_back(
            {"shadow rounds",
             fmt::format("{}, and each after the first shades pixels again: --lights K chooses among "
                         "the lights, and --first-shadows inline needs no rounds",
                         counters.shadowRounds)});
    }
    rows.push_back(
        {"memory",
         fmt::format("{} in {} images and {} buffers, {:.1f} bytes a pixel, in {} band{}",
                     formatBytes(report.footprint.bytes), report.footprint.images, report.footprint.buffers,
                     bytesOfPixel, report.memory.bands, report.memory.bands == 1 ? "" : "s")});
    rows.push_back({"bytes moved", summaryOf(report.traffic)});
    if (report.textures.images > 0) {
        rows.push_back({"textures", toText(report.textures)});
    }
    if (scene.narrowedTextures > 0) {
        rows.push_back(
            {"narrow textures", fmt::format("{} of 16 bits read as 8: the device filters no 16-bit images",
                                            scene.narrowedTextures)});
    }
    if (counters.unknownShader > 0) {
        rows.push_back({"unknown shader", fmt::format("{} hits", counters.unknownShader)});
    }
    if (counters.nonFinite > 0) {
        rows.push_back({"no number", fmt::format("{} samples, taken as black", counters.nonFinite)});
    }
    Rows passes{{"pass of the last sample", "ms"}};
    for (const PassTiming& pass : report.passes) {
        passes.push_back({titleOf(pass, report, detail), fmt::format("{:.3f}", pass.milliseconds)});
    }
    const std::string frames = report.frames.empty() ? "" : tableOf(report.frames) + "\n";
    std::string text = formatFields(rows, detail) + "\n" + frames + formatTable(passes, detail);
    if (report.hasDetails) {
        text += '\n';
        text += toText(report.memory);
        text += '\n';
        text += toText(report.traffic);
    }
    if (report.pipelines.statistics) {
        text += '\n';
        text += tableOf(*report.pipelines.statistics);
    }
    return text;
}

}  // namespace glint::cli

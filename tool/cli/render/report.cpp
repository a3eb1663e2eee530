#include "cli/render/report.h"

#include "cli/report.h"
#include "cli/table.h"
#include "emit/package/json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <numbers>

namespace glint::cli {

namespace {

base::Json toJson(const std::optional<EnvironmentReport>& environment) {
    if (!environment) {
        return nullptr;
    }
    const Environment::Statistics& statistics = environment->statistics;
    return {{"file", environment->file},         {"width", statistics.width},
            {"height", statistics.height},       {"levels", statistics.levels},
            {"halfFloat", statistics.halfFloat}, {"filterMs", statistics.filterMs}};
}

base::Json toJson(const std::optional<scene_view::SkyChoice>& sky) {
    if (!sky) {
        return nullptr;
    }
    return {{"scale", sky->scale},
            {"automatic", sky->automatic},
            {"luminance", scene_view::meanIlluminance(sky->sky()) / std::numbers::pi},
            {"lightIlluminance", base::orNull(sky->lights)}};
}

base::Json sunToJson(const RenderReport& report) {
    return report.sun ? base::Json{{"illuminance", report.sun->intensity},
                                   {"direction", report.sun->direction},
                                   {"automatic", report.sunAutomatic}}
                      : base::Json(nullptr);
}

// Describes the added light in one line.
std::string sunText(const RenderReport& report) {
    const std::string lux = fmt::format("{:.3g} lux", report.sun->intensity[0]);
    return lux + (report.sunAutomatic ? ", added because the scene has no light (--no-sun leaves it out)"
                                      : " (--sun)");
}

constexpr std::string_view nameOf(MotionStatistics::TopLevel action) {
    switch (action) {
        case MotionStatistics::TopLevel::Updated:
            return "updated";
        case MotionStatistics::TopLevel::Rebuilt:
            return "rebuilt";
        default:
            return "kept";
    }
}

base::Json toJson(const std::vector<FrameReport>& frames) {
    base::Json list = base::Json::array();
    for (const FrameReport& frame : frames) {
        list.push_back({{"frame", frame.frame},
                        {"seconds", frame.seconds},
                        {"image", frame.image},
                        {"deformed", frame.motion.deformed},
                        {"refits", frame.motion.refits},
                        {"rebuilds", frame.motion.rebuilds},
                        {"topLevel", nameOf(frame.motion.topLevel)},
                        {"poseMs", frame.poseMs},
                        {"updateMs", frame.updateMs},
                        {"deformMs", frame.motion.deformMs},
                        {"blasMs", frame.motion.blasMs},
                        {"tlasMs", frame.motion.tlasMs},
                        {"renderMs", frame.renderMs},
                        {"deviceMs", frame.deviceMs}});
    }
    return list;
}

std::string tableOf(const std::vector<FrameReport>& frames) {
    std::vector<std::vector<std::string>> rows{{"frame", "seconds", "refitted", "rebuilt", "TLAS", "pose ms",
                                                "deform", "BLAS", "TLAS", "render", "passes"}};
    const auto number = [](double value) { return fmt::format("{:.3f}", value); };
    for (const FrameReport& frame : frames) {
        const MotionStatistics& motion = frame.motion;
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
    std::uint32_t EffectCounters::*count;
};
constexpr Gate kGates[] = {
    {"sky", &EffectCounters::skippedSky},       {"unlit", &EffectCounters::skippedUnlit},
    {"rough", &EffectCounters::skippedRough},   {"black", &EffectCounters::skippedBlack},
    {"absent", &EffectCounters::skippedAbsent}, {"faint", &EffectCounters::skippedFaint},
    {"facing", &EffectCounters::skippedFacing}, {"range", &EffectCounters::skippedRange},
    {"cone", &EffectCounters::skippedCone},
};

base::Json effectsToJson(const FrameCounters& counters) {
    base::Json list = base::Json::array();
    for (const EffectCounters& effect : counters.effects) {
        base::Json skipped = base::Json::object();
        for (const Gate& gate : kGates) {
            skipped[gate.name] = effect.*gate.count;
        }
        list.push_back({{"name", effect.name},
                        {"rays", effect.rays},
                        {"hits", effect.hits},
                        {"misses", effect.misses},
                        {"segments", effect.segments},
                        {"screenHits", effect.screenHits},
                        {"skipped", skipped},
                        {"buckets", effect.bucketCounts}});
    }
    return list;
}

std::string effectText(const EffectCounters& effect) {
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
    return pass.pass == Pass::ShadeCase
               ? "shade " + shaderTitle(pass.shaderId, report.caseNames.at(pass.shaderId), detail)
               : pass.name;
}

// Describes the choice in one line.
std::string toText(const scene_view::SkyChoice& choice) {
    const double mean = scene_view::meanIlluminance(choice.sky()) / std::numbers::pi;
    const std::string what =
        fmt::format("{:.3g} cd/m² on average, {:.3g} times the default", mean, choice.scale);
    if (!choice.automatic) {
        return what + " (--sky)";
    }
    return choice.lights ? fmt::format("{}, for lights of {:.3g} lux", what, *choice.lights) : what;
}

base::Json toJson(const TextureReport& textures) {
    base::Json levels = base::Json::array();
    for (const std::optional<std::uint32_t>& level : textures.levels) {
        levels.push_back(base::orNull(level));
    }
    return {{"images", textures.images}, {"formats", textures.formats}, {"texels", textures.texels},
            {"bytes", textures.bytes},   {"found", textures.found},     {"levels", std::move(levels)}};
}

std::string toText(const TextureReport& textures) {
    std::vector<std::string> formats;
    for (const auto& [name, count] : textures.formats) {
        formats.push_back(fmt::format("{} {}", count, name));
    }
    std::string text =
        fmt::format("{}: {}, {:.2f} bytes a texel", fmt::join(formats, ", "), formatBytes(textures.bytes),
                    static_cast<double>(textures.bytes) /
                        static_cast<double>(std::max<std::uint64_t>(textures.texels, 1)));
    if (!textures.levels.empty()) {
        std::vector<std::string> levels;
        for (const std::optional<std::uint32_t>& level : textures.levels) {
            levels.push_back(level ? fmt::format("{}", *level) : "-");
        }
        text += fmt::format("; finest levels read: {}", fmt::join(levels, " "));
    }
    return text;
}

}  // namespace

void RenderReport::addHits(const FrameCounters& sample) {
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

base::Json toJson(const RenderReport& report) {
    const GpuScene::Statistics& scene = report.sceneStatistics;
    const FrameCounters& counters = report.counters;
    base::Json passes = base::Json::array();
    for (const PassTiming& pass : report.passes) {
        passes.push_back(base::Json{
            {"name", pass.name},
            {"shaderId", pass.pass == Pass::ShadeCase ? base::Json(pass.shaderId) : base::Json(nullptr)},
            {"milliseconds", pass.milliseconds}});
    }
    return {{"scene", report.scene},
            {"sceneInFile", base::jsonOf(orNone(report.sceneInFile))},
            {"image", report.image},
            {"device", report.device},
            {"driver", report.driver},
            {"strategy", report.strategy},
            {"strategyChoice", base::jsonOf(report.strategyChoice)},
            {"tracer", report.tracer},
            {"ordering", base::orNull(report.ordering)},
            {"merge", base::orNull(report.merge)},
            {"alpha", report.alpha},
            {"width", report.width},
            {"height", report.height},
            {"spp", report.samples},
            {"seed", report.seed},
            {"camera", report.camera},
            {"exposure", report.exposure},
            {"exposureAutomatic", report.exposureAutomatic},
            {"sky", toJson(report.sky)},
            {"sun", sunToJson(report)},
            {"cases", report.cases},
            {"compileMs", base::orNull(report.compileMs)},
            {"environment", toJson(report.environment)},
            {"sceneStatistics",
             {{"triangles", scene.triangles},
              {"geometries", scene.geometries},
              {"instances", scene.instances},
              {"blasCount", scene.blasCount},
              {"blasBytes", scene.blasBytes},
              {"blasUncompactedBytes", scene.blasUncompactedBytes},
              {"narrowedTextures", scene.narrowedTextures},
              {"maskedTriangles", scene.maskedTriangles},
              {"provedOpaque", scene.provedOpaque},
              {"provedTransparent", scene.provedTransparent},
              {"micromaps", scene.micromaps},
              {"micromapBytes", scene.micromapBytes},
              {"opacityMs", scene.opacityMs},
              {"orderMs", scene.orderMs},
              {"blasBuildMs", scene.blasBuildMs},
              {"tlasBuildMs", scene.tlasBuildMs}}},
            {"textures", toJson(report.textures)},
            {"pipelineCreationMs", report.pipelines.making.milliseconds},
            {"pipelineThreads", report.pipelines.making.threads},
            {"pipelineCache", cacheToJson(report.pipelines)},
            {"pipelineStatistics", base::jsonOf(report.pipelines.statistics)},
            {"start", toJson(report.start)},
            {"renderMs", report.renderMs},
            {"frames", toJson(report.frames)},
            {"passes", passes},
            {"counters",
             {{"rays", counters.rays},
              {"raysOfBounces", counters.raysOfBounces},
              {"shadowRays", counters.shadowRays},
              {"orderErrors", counters.orderErrors},
              {"unknownShader", counters.unknownShader},
              {"alphaTests", counters.alphaTests},
              {"nonFinite", counters.nonFinite},
              {"buckets", counters.bucketCounts}}},
            {"view", report.view ? measure::toJson(*report.view) : base::Json(nullptr)},
            {"effects", effectsToJson(counters)},
            {"footprint",
             {{"pipelines", report.footprint.pipelines},
              {"images", report.footprint.images},
              {"buffers", report.footprint.buffers},
              {"bytes", report.footprint.bytes}}},
            {"memory", toJson(report.memory)},
            {"traffic", toJson(report.traffic)}};
}

TextureReport textureReport(std::span<const ImageView> images) {
    TextureReport report;
    for (const ImageView& image : images) {
        const bool isBlitted = !isBlockFormat(image.format);
        const auto most = static_cast<std::uint32_t>(std::bit_width(std::max(image.width, image.height)));
        ++report.images;
        ++report.formats[infoOf(image.format).name];
        report.texels += std::uint64_t{image.width} * image.height;
        report.bytes += image.byteCount(isBlitted ? most : image.levels);
    }
    return report;
}

std::string toText(const RenderReport& report, Detail detail) {
    const GpuScene::Statistics& scene = report.sceneStatistics;
    const FrameCounters& counters = report.counters;
    std::vector<std::vector<std::string>> rows{
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
    for (const EffectCounters& effect : counters.effects) {
        if (!report.countsLight && effect.kind != package::EffectKind::Rays) {
            continue;  // not counted
        }
        rows.push_back({effect.name, effectText(effect)});
    }
    if (counters.raysOfBounces.size() > 1) {
        rows.push_back({"rays by bounce", fmt::format("{}", fmt::join(counters.raysOfBounces, ", "))});
    }
    rows.push_back(
        {"memory", fmt::format("{} in {} images and {} buffers", formatBytes(report.footprint.bytes),
                               report.footprint.images, report.footprint.buffers)});
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
    std::vector<std::vector<std::string>> passes{{"pass of the last sample", "ms"}};
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

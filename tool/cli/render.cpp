// glint render: renders a picture of a scene with the runtime.
#include "base/clock.h"
#include "base/files.h"
#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/compile/cache.h"
#include "cli/options/effect_options.h"
#include "cli/render/arguments.h"
#include "cli/render/frames.h"
#include "cli/render/open_image_denoise.h"
#include "cli/render/pipeline_cache.h"
#include "cli/render/report.h"
#include "gltf/import.h"
#include "image/image_file.h"
#include "inspect/pipelines.h"

#include <glint/context.h>
#include <glint/measure/observer.h>
#include <glint/measure/profile.h>
#include <glint/measure/render_settings.h>
#include <glint/measure/strategy_advice.h>
#include <glint/package.h>
#include <glint/renderer.h>
#include <glint/scene_view/camera.h>
#include <glint/scene_view/environment.h>
#include <glint/scene_view/package.h>
#include <glint/scene_view/pose.h>
#include <glint/scene_view/scene_view.h>
#include <glint/scene_view/textures.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

namespace glint::cli {

namespace {

// Returns the package `given` by --package, after checking it, or compiles one now. Fills in the report's
// members about it.
Result<Package> obtainPackage(const Console& console, const RenderArguments& arguments,
                              const compiler::PlanOptions& plan, std::uint32_t tracers,
                              const gltf::Scene& scene, std::optional<Result<Package>> given,
                              compiler::ModuleCache* cache, RenderReport& report) {
    if (given) {
        Result<Package>& package = *given;
        if (!package) {
            return std::move(package);
        }
        const scene_view::PackageDemand demand{*arguments.strategy, arguments.renderer.tracer,
                                               !arguments.environment.empty()};
        Status checked = scene_view::checkPackage(*package, arguments.package, demand, scene);
        const bool isLit = measure::addsSun(arguments, scene) ||
                           std::ranges::any_of(scene.lights, [](const gltf::Light& light) {
                               return light.shines() || light.canShine;
                           });
        if (checked && isLit && package->shape().effects.lights == 0) {
            console.report(Diagnostic{Severity::Note, "effect-absent", arguments.package,
                                      "has no effect shadow, so the lights of the picture cast no shadows",
                                      "compile it with --effects auto,shadow, or render with --no-sun"});
        }
        return checked ? std::move(package) : Result<Package>(checked.error());
    }
    const base::Clock::time_point start = base::Clock::now();
    compiler::CompileSettings settings = measure::compileSettings(arguments, plan, tracers, scene);
    settings.progress = console.countTo("compiling");
    console.report(effectWarnings(gltf::SceneList({&scene, 1}), settings));
    Result<Package> package = scene_view::compileAndLoad(scene, settings, cache);
    report.compileMs = base::millisecondsSince(start);
    report.merge = nameOf(plan.merge);
    return package;
}

// `given` is the package of --package, if there is one. Its errors are reported when it is used.
Result<std::unique_ptr<Context>> makeContext(const RenderArguments& arguments,
                                             const std::optional<Result<Package>>& given) {
    HeadlessOptions options = measure::deviceOptions(arguments);
    options.pipelineStatistics = options.pipelineStatistics || arguments.pipelineStatistics;
    if (given && *given) {
        inspect::requirePackage(**given, options);
    }
    return Context::createHeadless(options);
}

// Returns null if no map is given. Fills in the report's members about it.
Result<std::unique_ptr<Environment>> obtainEnvironment(const Console& console,
                                                       const RenderArguments& arguments, Context& context,
                                                       const Package& package, RenderReport& report) {
    const std::string& file = arguments.environment;
    if (file.empty()) {
        return std::unique_ptr<Environment>();
    }
    console.progress("filtering " + file);
    std::vector<Diagnostic> notes;
    Result<std::unique_ptr<Environment>> environment =
        scene_view::loadEnvironment(context, file, {.sampled = package.skyLight()}, notes);
    console.report(notes);
    if (environment) {
        report.environment = {file, (*environment)->statistics()};
    }
    return environment;
}

// A value that is not a number points to the scene's own numbers rather than to the shaders.
void warnOfNonFinite(const Console& console, const RenderReport& report) {
    console.report(makeWarning(
        "non-finite", report.scene,
        fmt::format("{} samples of pixels were NaN or infinite and count as black",
                    report.counters.nonFinite),
        "look for NaN, infinite or very large values among the scene's factors, colours and lights"));
}

// Replaces --strategy auto by the strategy that is expected to be fastest.
Status settleStrategy(const Console& console, const compiler::PlanOptions& plan, Context& context,
                      const gltf::Scene& scene, const std::optional<Result<Package>>& given,
                      RenderArguments& arguments, RenderReport& report) {
    if (arguments.strategy) {
        return okStatus();
    }
    if (given && !*given) {
        return given->error();
    }
    std::vector<Diagnostic> warnings;
    Result<compiler::StrategyAdvice> advice =
        measure::adviseRender(arguments, plan, context, scene, given ? &**given : nullptr, warnings);
    console.report(warnings);
    if (!advice) {
        return advice.error();
    }
    console.detail(fmt::format("strategy {}: {}", advice->choice.strategy, advice->choice.why));
    report.strategy = advice->choice.strategy;
    report.strategyChoice = *advice;
    arguments.strategy = valueNamed<package::Strategy>(advice->choice.strategy);
    arguments.compile.strategyChoice = std::move(*advice);
    return okStatus();
}

// Reports options that were given and change nothing.
void reportIdle(const Console& console, const RenderArguments& arguments, const compiler::PlanOptions& plan,
                const gltf::Scene& scene, const std::optional<Result<Package>>& given) {
    compiler::Settings settings = arguments;
    if (given && *given) {
        // The package has decided which effects there are.
        settings.compile.effects = {false, (*given)->shape().effects.all};
    }
    console.report(idleSettings({&scene, 1}, compiler::kOfRender, settings, plan));
    const Result<image::ImageFormat> format = image::imageFormat(arguments.output);
    if (arguments.exposure != "auto" && format && *format == image::ImageFormat::Exr) {
        console.report(idleWarning(arguments.scene, "--exposure " + arguments.exposure,
                                   "an EXR file keeps the light as it is"));
    }
}

std::array<std::uint8_t, 3> colorOf(PixelPath path) {
    switch (path) {
        case PixelPath::Screen:
            return {230, 159, 0};
        case PixelPath::Hit:
            return {0, 114, 178};
        case PixelPath::Miss:
            return {86, 180, 233};
        case PixelPath::NoRay:
            return {90, 90, 90};
        case PixelPath::NoSurface:
            break;
    }
    return {0, 0, 0};
}

// The colours are those of Okabe and Ito, "Color Universal Design" (2008). Colour-blind people can tell them
// apart, and they differ in lightness. Orange: found in screen space. Blue: a ray that hit. Light blue: a ray
// that left the scene. Grey: no ray. Black: no surface. `paths` has width * height pixels.
image::DisplayImage coverageMap(const std::vector<PixelPath>& paths, std::uint32_t width,
                                std::uint32_t height) {
    image::DisplayImage image{width, height, {}};
    image.pixels.reserve(paths.size());
    for (const PixelPath path : paths) {
        image.pixels.push_back(colorOf(path));
    }
    return image;
}

// Writes everything that comes after the pictures.
Status writeResults(const RenderArguments& arguments, const RenderReport& report) {
    if (!arguments.coverage.empty()) {
        const image::DisplayImage map = coverageMap(report.paths, report.width, report.height);
        GLINT_TRY_DO(writeImage(arguments.coverage, map));
    }
    return arguments.stats.empty() ? okStatus()
                                   : base::writeFile(arguments.stats, base::toText(toJson(report)));
}

// Reads the scene's images in the formats of the device. Those that are compressed for it stay in the cache
// of compiled modules.
Status readTextures(const Console& console, const RenderArguments& arguments, const Context& context,
                    const Package& package, const gltf::Scene& scene, CompileCache& cache,
                    scene_view::SceneViewData& data, RenderReport& report) {
    console.progress("reading textures of " + arguments.scene);
    GLINT_TRY(auto textures, scene_view::loadTextures(
                                 scene, measure::textureOptions(arguments, context, package, cache.store())));
    console.report(textures->notes);
    report.start.texturesMs = textures->milliseconds;
    const std::uint32_t found = textures->found;
    scene_view::useTextures(std::move(textures), data);
    report.textures = textureReport(data.images);
    report.textures.found = found;
    return okStatus();
}

// Chooses the camera for an animated scene. A camera that frames everything frames all that is visible at any
// moment, and does not move.
Result<scene_view::CameraChoice> chooseView(const std::optional<Movement>& movement,
                                            const RenderArguments& arguments, gltf::Scene& scene,
                                            scene_view::SceneViewData& data, double aspect) {
    if (!movement) {
        return scene_view::chooseCamera(scene, data, arguments.camera, aspect);
    }
    scene_view::Bounds bounds = scene_view::Bounds{{1.0, 1.0, 1.0}, {-1.0, -1.0, -1.0}};
    if (scene_view::framesEverything(scene, arguments.camera)) {
        // This many moments show well enough how far the scene moves.
        constexpr std::size_t kMostMoments = 64;
        const std::size_t step = (movement->moments.size() + kMostMoments - 1) / kMostMoments;
        for (std::size_t i = 0; i < movement->moments.size(); i += step) {
            scene_view::applyPose(
                scene_view::poseAt(scene, movement->animations, movement->moments[i].seconds), scene);
            scene_view::poseSceneView(scene, data);
            bounds = scene_view::united(bounds, scene_view::posedBounds(scene, data));
        }
    }
    scene_view::applyPose(scene_view::poseAt(scene, movement->animations, movement->moments.front().seconds),
                          scene);
    Result<scene_view::CameraChoice> camera =
        scene_view::chooseCameraAround(scene, bounds, arguments.camera, aspect);
    // The package must not depend on which frames are rendered.
    scene_view::applyPose(scene_view::restPose(scene), scene);
    return camera;
}

// Returns what --view difference compares with, if there is any.
Result<std::optional<LinearImage>> readReference(const RenderArguments& arguments) {
    if (arguments.viewReference.empty()) {
        return std::optional<LinearImage>();
    }
    GLINT_TRY(auto read, image::readImage(arguments.viewReference));
    if (read.width != arguments.renderer.width || read.height != arguments.renderer.height) {
        return makeError("view-reference", arguments.viewReference,
                         fmt::format("has {}x{} pixels, and the picture {}x{}", read.width, read.height,
                                     arguments.renderer.width, arguments.renderer.height),
                         "render both with the same --size");
    }
    return std::optional<LinearImage>(std::move(read));
}

// Does all the work between reading the scene and writing the files.
Status render(const Console& console, const RenderArguments& asked, gltf::Scene& scene,
              const gltf::SceneList& scenes, const measure::PlanChoice& chosen,
              std::optional<Result<Package>> given, CompileCache& cache, RenderReport& report) {
    RenderArguments arguments = asked;
    compiler::Settings& settings = arguments;
    settings = withSettings(settings, chosen.decided);
    const compiler::PlanOptions& plan = chosen.options;
    GLINT_TRY(const auto movement, chooseMovement(arguments.motion, scene, !arguments.materials.empty()));
    GLINT_TRY(const auto compared, readReference(arguments));
    const std::optional<LinearImage>& reference = compared;
    scene_view::SceneViewData data = measure::sceneView(arguments, scene);
    const double aspect = static_cast<double>(report.width) / report.height;
    GLINT_TRY(const auto camera, chooseView(movement, arguments, scene, data, aspect));
    report.camera = camera.name;
    if (measure::addsSun(arguments, scene)) {
        report.sun = scene_view::sunLight();
        report.sunAutomatic = arguments.sun == compiler::Sun::Auto;
    }
    report.sceneInFile = gltf::sceneInFile(scene);
    // This comes before the compilation, which takes longer than finding out that there is no device.
    const base::Clock::time_point begin = base::Clock::now();
    GLINT_TRY(const auto context, makeContext(arguments, given));
    PipelineCacheFile pipelineCache(console, *context,
                                    pipelineCacheFolder(arguments.pipelines, arguments.cache));
    report.start.deviceMs = base::millisecondsSince(begin);
    report.device = context->deviceName();
    report.driver = context->driverName();
    GLINT_TRY_DO(settleStrategy(console, plan, *context, scene, given, arguments, report));
    reportIdle(console, arguments, plan, scene, given);
    console.progress("compiling " + arguments.scene);
    const Result<Package> package = obtainPackage(console, arguments, plan, context->handles().tracers, scene,
                                                  std::move(given), cache.modules(), report);
    if (!package) {
        return package.error();
    }
    GLINT_TRY(const auto environment, obtainEnvironment(console, arguments, *context, *package, report));
    data.packageScene = scene_view::sceneIn(*package, scene).value_or(0);
    scene_view::useLayoutOf(*package, scene, data);
    GLINT_TRY_DO(readTextures(console, arguments, *context, *package, scene, cache, data, report));
    cache.close(console);
    report.alpha = nameOf(package->alpha());
    report.cases = package->caseCount();
    for (const package::CaseEntry& entry : package->cases()) {
        report.caseNames.emplace_back(package->string(entry.name));
    }
    console.progress("rendering " + arguments.scene);
    RendererOptions options = measure::rendererOptions(arguments);
    options.accumulate = arguments.samples > 1;
    if (!arguments.coverage.empty()) {
        options.bands = 1;  // the coverage is that of all pixels at once
    }
    options.pipelineStatistics = arguments.pipelineStatistics && context->handles().pipelineStatistics;
    if (arguments.pipelineStatistics && !options.pipelineStatistics) {
        console.report(Diagnostic{Severity::Note, "pipeline-statistics", report.device,
                                  "has no VK_KHR_pipeline_executable_properties: there are no statistics",
                                  "leave out --pipeline-statistics, or use another device"});
    }
    const FrameSetup setup{console,
                           arguments,
                           options,
                           environment.get(),
                           movement,
                           camera,
                           aspect,
                           reference ? &*reference : nullptr,
                           console.countTo("rendering sample")};
    bool warned = false;
    const auto accept = [&]() -> Result<bool> {
        GLINT_TRY_DO(measure::checkValidation(console, *context));
        if (report.counters.nonFinite > 0 && !std::exchange(warned, true)) {
            warnOfNonFinite(console, report);
        }
        if (console.refused()) {
            return false;
        }
        const Status ordered = checkOrder(report);
        return ordered ? Result<bool>(true) : Result<bool>(ordered.error());
    };
    GLINT_TRY_DO(renderFrames(*context, *package, setup, scene, data, accept, report));
    pipelineCache.save();
    if (!pipelineCache.path().empty()) {
        report.pipelines.cache = {pipelineCache.path().string(), pipelineCache.loadedBytes(),
                                  pipelineCache.savedBytes()};
    }
    if (console.refused()) {
        return okStatus();
    }
    Status done = writeResults(arguments, report);
    if (!done || arguments.profileOutput.empty()) {
        return done;
    }
    std::vector<Diagnostic> warnings;
    done = measure::writeProfile(arguments.profileOutput, scenes, plan, report.hits, warnings);
    console.report(warnings);
    return done;
}

int run(const Console& console, const RenderArguments& arguments) {
    RenderReport report;
    report.scene = arguments.scene;
    report.image = arguments.output;
    report.strategy = compiler::sweptSetting("strategy")->values.text(arguments);
    report.samples = arguments.samples;
    report.seed = arguments.frame.seed;
    report.width = arguments.renderer.width;
    report.height = arguments.renderer.height;

    const std::optional<FrameRange> frames = parseFrames(arguments.motion.frames);
    Status status = okStatus();
    for (const std::string& file :
         {frames ? numberedFile(arguments.output, frames->first).string() : arguments.output, arguments.stats,
          arguments.coverage, arguments.profileOutput}) {
        if (status && !file.empty()) {
            status = base::checkOutputFile(file);
        }
    }
    if (status && arguments.denoise) {
        status = checkDenoiser();
    }
    if (!status) {
        console.report(status.error());
        return kExitFailed;
    }
    console.progress("reading " + arguments.scene);
    CompileCache cache(arguments.cache, "");
    Result<gltf::ImportOptions> import = importOptions(arguments, ImageReading::Files, cache.store());
    if (!import) {
        console.report(import.error());
        return kExitFailed;
    }
    std::optional<Result<Package>> given;
    if (!arguments.package.empty()) {
        given = Package::load(arguments.package);
        // Keys depend on it, and the scene has to have those of the package.
        import->trustTextures = *given ? (*given)->trustTextures() : import->trustTextures;
    }
    Result<gltf::Scene> scene = importScene(arguments.scene, *import);
    if (!scene) {
        console.report(scene.error());
        return kExitFailed;
    }
    console.report(scene->warnings);
    const gltf::SceneList scenes({&*scene, 1});
    compiler::Settings planned = static_cast<const compiler::Settings&>(arguments);
    if (!arguments.package.empty()) {
        planned.alpha = package::AlphaPolicy::Opaque;  // The package has decided, so nothing is chosen here.
    }
    const Result<measure::PlanChoice> plan = measure::choosePlan(planned, scenes);
    if (!plan) {
        console.report(plan.error());
        return kExitFailed;
    }
    console.report(plan->warnings);
    console.report(plan->notes);
    if (console.refused()) {
        return kExitFailed;
    }
    status = render(console, arguments, *scene, scenes, *plan, std::move(given), cache, report);
    if (!status) {
        console.report(status.error());
        return kExitFailed;
    }
    if (console.refused()) {
        return kExitFailed;
    }
    if (console.isJson()) {
        console.result(toJson(report));
    } else {
        console.print(toText(report, console.isVerbose() ? Detail::Whole : Detail::Short));
    }
    return kExitDone;
}

}  // namespace

void addRender(CLI::App& app, Action& chosen) {
    CLI::App& command = addCommand(
        app,
        {.name = "render",
         .what = "Render a scene with its compiled shaders",
         .examples = {"glint render scene.gltf -o scene.png",
                      "glint render scene.gltf -o scene.png --size 1280x720 --spp 64 --bounces 4 --denoise"},
         .usual = {"--output", "--size", "--spp", "--camera", "--environment", "--exposure", "--bounces",
                   "--strategy", "--frames", "--denoise"}});
    const auto arguments = std::make_shared<RenderArguments>();
    addRenderOptions(command, arguments, [arguments, &chosen] {
        chosen = [arguments](const Console& console) { return run(console, *arguments); };
    });
}

}  // namespace glint::cli

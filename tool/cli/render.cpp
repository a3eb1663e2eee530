// glint render: renders a picture of a scene with the runtime.
#include "base/clock.h"
#include "base/files.h"
#include "base/lists.h"
#include "cli/cache.h"
#include "cli/command_line.h"
#include "cli/options/options.h"
#include "cli/render/frames.h"
#include "image/image_file.h"
#include "inspect/pipelines.h"
#include "resolve/light.h"
#include "resolve/profile.h"
#include "resolve/resolve.h"

#include <glint/context.h>
#include <glint/measure/observer.h>
#include <glint/measure/target.h>
#include <glint/measure/views.h>
#include <glint/package.h>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

namespace glint::cli {

namespace {

// Returns the settings of the command line, with the needs of views, denoiser and reports.
compiler::Settings settingsOf(const RenderArguments& arguments) {
    compiler::Settings asked = arguments;
    if (const std::optional<measure::ViewChoice> view = measure::parseView(arguments.view)) {
        asked.readLayers = measure::layersFor(*view);
    }
    if (arguments.denoise) {
        std::ranges::copy(denoiserLayers(), std::back_inserter(asked.readLayers));
    }
    asked.countsHits = !arguments.profileOutput.empty();
    asked.renderer.accumulate = arguments.samples > 1;
    if (!arguments.coverage.empty()) {
        asked.renderer.bands = 1;  // the coverage is that of all pixels at once
    }
    return asked;
}

// Returns the package `given` by --package, after checking it, or compiles one now. Fills in the report's
// members about it.
Result<std::shared_ptr<const Package>> obtainPackage(const Console& console, const compiler::Build& build,
                                                     const std::shared_ptr<const Package>& given,
                                                     compiler::ModuleCache* cache, RenderReport& report) {
    const compiler::Settings& settings = build.settings;
    const base::Clock::time_point start = base::Clock::now();
    GLINT_TRY(auto package, session::packageFor(build, given, cache));
    if (given == nullptr) {
        report.compileMs = base::millisecondsSince(start) + build.milliseconds;
        report.merge = nameOf(settings.compile.plan.merge);
    } else if (package->shape().effects.lights == 0 &&
               (settings.sun == compiler::Sun::On ||
                std::ranges::any_of(build.scenes->scenes().front().lights, [](const gltf::Light& light) {
                    return light.shines() || light.canShine;
                }))) {
        console.report(Diagnostic{Severity::Note, "effect-absent", settings.package,
                                  "has no effect shadow, so the lights of the picture cast no shadows",
                                  "compile it with --effects auto,shadow, or render with --no-sun"});
    }
    report.alpha = nameOf(package->alpha());
    report.cases = package->caseCount();
    for (const package::CaseEntry& entry : package->cases()) {
        report.caseNames.emplace_back(package->string(entry.name));
    }
    return package;
}

Result<std::unique_ptr<Context>> makeContext(const RenderArguments& arguments, const Package* given) {
    HeadlessOptions options = session::deviceOptions(settingsOf(arguments));
    options.pipelineStatistics = options.pipelineStatistics || arguments.pipelineStatistics;
    if (given != nullptr) {
        inspect::requirePackage(*given, options);
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
        session::loadEnvironment(context, file, {.sampled = package.skyLight()}, notes);
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

// Decides what the command line leaves open, and reports it with the options that change nothing.
Result<compiler::Build> resolve(const Console& console, const RenderArguments& arguments, Context& context,
                                std::span<const gltf::Scene> scenes, const Package* package,
                                RenderReport& report) {
    compiler::Settings asked = settingsOf(arguments);
    asked.renderer.pipelineStatistics = arguments.pipelineStatistics && context.handles().pipelineStatistics;
    // Counting takes time that would be added to that of the passes.
    asked.renderer.countsLight = !arguments.stats.empty();
    asked.compile.progress = console.countTo("compiling");
    GLINT_TRY(const auto target, measure::targetOf(asked, context, package, scenes.front()));
    GLINT_TRY(auto build, compiler::resolve(scenes, asked, target));
    console.report(build.messages);
    if (const std::optional<compiler::StrategyAdvice>& advice = build.settings.compile.strategyChoice) {
        console.detail(fmt::format("strategy {}: {}", advice->choice.strategy, advice->choice.why));
        report.strategy = advice->choice.strategy;
        report.strategyChoice = advice;
    }
    console.report(idleSettings(build));
    const Result<image::ImageFormat> format = image::imageFormat(arguments.output);
    if (arguments.exposure != "auto" && format && *format == image::ImageFormat::Exr) {
        console.report(idleWarning(arguments.scene, "--exposure " + arguments.exposure,
                                   "an EXR file keeps the light as it is"));
    }
    if (arguments.pipelineStatistics && !asked.renderer.pipelineStatistics) {
        console.report(Diagnostic{Severity::Note, "pipeline-statistics", report.device,
                                  "has no VK_KHR_pipeline_executable_properties: there are no statistics",
                                  "leave out --pipeline-statistics, or use another device"});
    }
    return build;
}

std::array<std::uint8_t, 3> colorOf(Renderer::PixelPath path) {
    switch (path) {
        case Renderer::PixelPath::Screen:
            return {230, 159, 0};
        case Renderer::PixelPath::Hit:
            return {0, 114, 178};
        case Renderer::PixelPath::Miss:
            return {86, 180, 233};
        case Renderer::PixelPath::NoRay:
            return {90, 90, 90};
        case Renderer::PixelPath::NoSurface:
            break;
    }
    return {0, 0, 0};
}

// The colours are those of Okabe and Ito, "Color Universal Design" (2008). Colour-blind people can tell them
// apart, and they differ in lightness. Orange: found in screen space. Blue: a ray that hit. Light blue: a ray
// that left the scene. Grey: no ray. Black: no surface. `paths` has width * height pixels.
image::DisplayImage coverageMap(const std::vector<Renderer::PixelPath>& paths, std::uint32_t width,
                                std::uint32_t height) {
    return {width, height,
            base::mapped<image::Color8>(paths, [](Renderer::PixelPath path) { return colorOf(path); })};
}

// Writes everything that comes after the pictures.
Status writeResults(const RenderArguments& arguments, const RenderReport& report) {
    if (!arguments.coverage.empty()) {
        const image::DisplayImage map = coverageMap(report.paths, report.width, report.height);
        GLINT_TRY_DO(writeImage(arguments.coverage, map));
    }
    return arguments.stats.empty() ? okStatus()
                                   : base::writeFile(arguments.stats, base::toText(base::jsonOf(report)));
}

// Reads the scene's images in the formats of the device. Those that are compressed for it stay in the cache
// of compiled modules.
Result<std::shared_ptr<const session::TextureSet>> readTextures(
    const Console& console, const RenderArguments& arguments, const Context& context, const Package& package,
    const gltf::Scene& scene, CompileCache& cache, RenderReport& report) {
    console.progress("reading textures of " + arguments.scene);
    GLINT_TRY(auto textures, session::loadTextures(
                                 scene, session::textureOptions(arguments, context, package, cache.store())));
    console.report(textures->notes);
    report.start.texturesMs += textures->milliseconds;
    return textures;
}

// Chooses the camera for an animated scene. A camera that frames everything frames all that is visible at any
// moment, and does not move.
Result<session::CameraChoice> chooseView(const std::optional<Movement>& movement,
                                         const RenderArguments& arguments, gltf::Scene& scene,
                                         session::SceneViewData& data, double aspect) {
    if (!movement) {
        return session::chooseCamera(scene, data, arguments.camera, aspect);
    }
    session::Bounds bounds = session::Bounds{{1.0, 1.0, 1.0}, {-1.0, -1.0, -1.0}};
    if (session::framesEverything(scene, arguments.camera)) {
        // This many moments show well enough how far the scene moves.
        constexpr std::size_t kMostMoments = 64;
        const std::size_t step = (movement->seconds.size() + kMostMoments - 1) / kMostMoments;
        for (std::size_t i = 0; i < movement->seconds.size(); i += step) {
            session::moveTo(movement->moment(i), scene);
            session::poseSceneView(scene, data);
            bounds = session::united(bounds, session::posedBounds(scene, data));
        }
    }
    session::moveTo(movement->moment(0), scene);
    Result<session::CameraChoice> camera =
        session::chooseCameraAround(scene, bounds, arguments.camera, aspect);
    // The package must not depend on which frames are rendered.
    session::moveTo(std::nullopt, scene);
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

// Reads the files that edits add, and makes all edits with a copy of the first of `scenes`, to find out
// whether they can be made. Where they need shaders, the copy joins the scenes of the package that is
// compiled.
Status planEdits(const Console& console, const RenderArguments& arguments, const Package* given,
                 const std::optional<Movement>& movement, std::vector<gltf::Scene>& scenes, EditPlan& plan) {
    if (plan.edits.empty()) {
        return okStatus();
    }
    const bool needShaders = session::needShaders(plan.edits);
    if (needShaders && given != nullptr && given->trustTextures()) {
        return makeError("package-mismatch", arguments.package,
                         "relies on what textures hold where they are now, and edits change materials",
                         "compile it with --no-trust-textures");
    }
    GLINT_TRY(auto import, session::importOptions(arguments, session::ImageReading::Files, nullptr));
    import.materialModel =
        scenes.front().materials.empty() ? import.materialModel : &scenes.front().materials.front().model();
    GLINT_TRY_DO(session::readFiles(plan.edits, import, plan.files));
    for (const auto& [file, read] : plan.files) {
        console.report(read->warnings);
    }
    GLINT_TRY(auto planned, session::plannedScene(scenes.front(), plan.edits, plan.files));
    if (needShaders && given == nullptr) {
        scenes.push_back(std::move(planned));
    }
    const std::int64_t last =
        movement && movement->isSequence
            ? movement->firstFrame + static_cast<std::int64_t>(movement->seconds.size()) - 1
            : std::int64_t{plan.edits.back().frame};
    const auto late =
        std::ranges::count_if(plan.edits, [&](const session::Edit& edit) { return edit.frame > last; });
    if (late > 0) {
        console.report(Diagnostic{
            Severity::Note, "edit-unused", arguments.edits,
            fmt::format("{} of {} edits come after the last frame, {}", late, plan.edits.size(), last),
            "render further frames"});
    }
    return okStatus();
}

// Does all the work between reading the scene and writing the files.
Status render(const Console& console, const RenderArguments& arguments, session::Opened opened,
              EditPlan edits, CompileCache& cache, RenderReport& report) {
    // Those that the package is made for; the first is drawn.
    std::vector<gltf::Scene> scenes;
    scenes.push_back(std::move(opened.scene));
    GLINT_TRY(const auto movement, chooseMovement(arguments.motion, scenes.front(),
                                                  !arguments.materials.empty() || !edits.edits.empty()));
    GLINT_TRY_DO(planEdits(console, arguments, opened.package.get(), movement, scenes, edits));
    gltf::Scene& scene = scenes.front();
    GLINT_TRY(const auto compared, readReference(arguments));
    session::SceneViewData data = session::sceneView(arguments, scene);
    const double aspect = static_cast<double>(report.width) / report.height;
    GLINT_TRY(const auto camera, chooseView(movement, arguments, scene, data, aspect));
    report.camera = camera.name;
    if (compiler::addsSun(arguments, scene)) {
        report.sun = RenderReport::Sun{session::sunLight(), arguments.sun == compiler::Sun::Auto};
    }
    report.sceneInFile = gltf::sceneInFile(scene);
    // This comes before the compilation, which takes longer than finding out that there is no device.
    const base::Clock::time_point begin = base::Clock::now();
    GLINT_TRY(const auto context, makeContext(arguments, opened.package.get()));
    PipelineCacheFile pipelineCache(console, *context,
                                    pipelineCacheFolder(arguments.pipelines, arguments.cache));
    report.start.deviceMs = base::millisecondsSince(begin);
    report.device = context->deviceName();
    report.driver = context->driverName();
    GLINT_TRY(const auto build, resolve(console, arguments, *context, scenes, opened.package.get(), report));
    if (console.refused()) {
        return okStatus();
    }
    console.progress("compiling " + arguments.scene);
    GLINT_TRY(auto package, obtainPackage(console, build, opened.package, cache.modules(), report));
    GLINT_TRY(const auto environment, obtainEnvironment(console, arguments, *context, *package, report));
    GLINT_TRY(const auto textures,
              readTextures(console, arguments, *context, *package, scene, cache, report));
    session::usePackage(*package, scene, textures, data);
    for (const auto& [file, read] : edits.files) {
        GLINT_TRY(edits.textures[file],
                  readTextures(console, arguments, *context, *package, *read, cache, report));
    }
    report.textures = textureReport(data.images);
    report.textures.found = textures->found;
    cache.close(console);
    console.progress("rendering " + arguments.scene);
    const FrameSetup setup{console,        arguments,
                           build.settings, environment.get(),
                           movement,       camera,
                           aspect,         compared ? &*compared : nullptr,
                           edits,          console.countTo("rendering sample")};
    bool warned = false;
    const auto accept = [&]() -> Result<bool> {
        GLINT_TRY_DO(measure::checkValidation(console, *context));
        if (report.counters.nonFinite > 0 && !std::exchange(warned, true)) {
            warnOfNonFinite(console, report);
        }
        if (console.refused()) {
            return false;
        }
        GLINT_TRY_DO(checkOrder(report));
        return true;
    };
    GLINT_TRY_DO(renderFrames(*context, std::move(package), setup, scene, std::move(data), accept, report));
    pipelineCache.save();
    if (!pipelineCache.path().empty()) {
        report.pipelines.cache = {pipelineCache.path().string(), pipelineCache.loadedBytes(),
                                  pipelineCache.savedBytes(), report.pipelines.making.cacheHits};
    }
    if (console.refused()) {
        return okStatus();
    }
    GLINT_TRY_DO(writeResults(arguments, report));
    std::vector<Diagnostic> warnings;
    Status done = arguments.profileOutput.empty()
                      ? okStatus()
                      : writeProfile(arguments.profileOutput, build, report.hits, warnings);
    console.report(warnings);
    return done;
}

Status readAndRender(const Console& console, const RenderArguments& arguments, RenderReport& report) {
    EditPlan edits;
    RenderArguments wanted = arguments;
    if (!arguments.edits.empty()) {
        GLINT_TRY(edits.edits, session::readEdits(arguments.edits));
        // Other primitives than those of the file may show a texture.
        wanted.compile.trustTextures = wanted.compile.trustTextures && !session::needShaders(edits.edits);
    }
    console.progress("reading " + arguments.scene);
    CompileCache cache(arguments.cache, "");
    GLINT_TRY(auto opened, session::open(arguments.scene, wanted, cache.store()));
    console.report(opened.scene.warnings);
    return console.refused() ? okStatus()
                             : render(console, wanted, std::move(opened), std::move(edits), cache, report);
}

Result<int> run(const Console& console, const RenderArguments& arguments) {
    const std::optional<FrameRange> frames = parseFrames(arguments.motion.frames);
    for (const std::string& file :
         {frames ? numberedFile(arguments.output, frames->first).string() : arguments.output, arguments.stats,
          arguments.coverage, arguments.profileOutput}) {
        if (!file.empty()) {
            GLINT_TRY_DO(base::checkOutputFile(file));
        }
    }
    if (arguments.denoise) {
        GLINT_TRY_DO(checkDenoiser());
    }
    RenderReport report;
    report.scene = arguments.scene;
    report.image = arguments.output;
    report.strategy = compiler::sweptSetting("strategy")->values.text(arguments);
    report.samples = arguments.samples;
    report.seed = arguments.frame.seed;
    report.width = arguments.renderer.width;
    report.height = arguments.renderer.height;
    GLINT_TRY_DO(readAndRender(console, arguments, report));
    if (console.refused()) {
        return kExitFailed;
    }
    answer(
        console, [&] { return base::jsonOf(report); }, [&](Detail detail) { return toText(report, detail); });
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

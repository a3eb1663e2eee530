// glint render: a picture of a scene through the runtime.
#include "cli/camera.h"
#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/coverage.h"
#include "cli/plan_choice.h"
#include "cli/render_arguments.h"
#include "cli/render_input.h"
#include "cli/render_profile.h"
#include "cli/render_report.h"
#include "cli/scene_view.h"
#include "gltf/import.h"
#include "image/image_file.h"
#include "image/tone.h"

#include <glint/context.h>
#include <glint/package.h>
#include <glint/renderer.h>

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

namespace glint {

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

SceneViewData sceneView(const RenderArguments& arguments, const Scene& scene) {
    SceneViewData data = makeSceneView(scene);
    if (arguments.addsSun(scene)) {
        data.lights.push_back(sunLight());
    }
    arguments.effectFrame.apply(data);
    return data;
}

// The package that is asked for, checked, or one that is made now; fills in what the report says of it.
Result<Package> obtainPackage(const Console& console, const RenderArguments& arguments,
                              const PlanOptions& plan, std::uint32_t tracers, const Scene& scene,
                              RenderReport& report) {
    if (!arguments.package.empty()) {
        Result<Package> package = Package::load(arguments.package);
        if (!package) {
            return package;
        }
        const PackageDemand demand{strategyOf(arguments), tracerOf(arguments),
                                   !arguments.environment.file.empty()};
        Status checked = checkPackage(*package, arguments.package, demand, scene);
        return checked ? std::move(package) : Result<Package>(checked.error());
    }
    const Clock::time_point start = Clock::now();
    CompileSettings settings;
    arguments.tracing.apply(settings, tracers);
    settings.environmentMap = !arguments.environment.file.empty();
    settings.plan = plan;
    arguments.accuracy.apply(settings);
    arguments.effects.apply(settings);
    settings.addsLight = arguments.addsSun(scene);
    console.report(effectWarnings(SceneList({&scene, 1}), settings));
    Result<Package> package = compileTemporary(scene, settings);
    report.compileMs = millisecondsSince(start);
    report.merge = std::string(toString(plan.merge));
    return package;
}

// Of the package in a folder, if there is one. What is wrong with it is told when it is used.
bool fetchesPositions(const std::string& folder) {
    const Result<Package> package = folder.empty() ? Result<Package>(Diagnostic{}) : Package::load(folder);
    return package && package->positionFetch();
}

Result<std::unique_ptr<Context>> makeContext(const RenderArguments& arguments) {
    HeadlessOptions options;
    options.validation = arguments.validate ? Validation::Synchronization : Validation::Off;
    options.deviceName = arguments.device;
    options.positionFetch = arguments.tracing.positionFetch || fetchesPositions(arguments.package);
    return Context::createHeadless(options);
}

// Null where none is asked for; fills in what the report says of it.
Result<std::unique_ptr<Environment>> obtainEnvironment(const Console& console,
                                                       const RenderArguments& arguments, Context& context,
                                                       RenderReport& report) {
    const std::string& file = arguments.environment.file;
    if (file.empty()) {
        return std::unique_ptr<Environment>();
    }
    console.progress("filtering " + file);
    std::vector<Diagnostic> notes;
    Result<std::unique_ptr<Environment>> environment = loadEnvironment(context, file, notes);
    console.report(notes);
    if (environment) {
        report.environment = {file, (*environment)->statistics()};
    }
    return environment;
}

RendererOptions rendererOptions(const RenderArguments& arguments, const RenderReport& report) {
    RendererOptions options;
    options.strategy = strategyOf(arguments);
    options.width = report.width;
    options.height = report.height;
    options.tracer = tracerOf(arguments);
    options.checkOrder = arguments.validate;
    arguments.frame.apply(options);
    arguments.effectFrame.apply(options);
    return options;
}

// Renders, and fills in what was measured.
Result<LinearImage> renderFrame(Context& context, const Package& package, const SceneViewData& data,
                                const Environment* environment, const RenderArguments& arguments,
                                const CameraView& camera, RenderReport& report) {
    const Result<std::unique_ptr<GpuScene>> scene = GpuScene::upload(context, package, data.view());
    if (!scene) {
        return scene.error();
    }
    report.sceneStatistics = (*scene)->statistics();
    const Result<std::unique_ptr<Renderer>> renderer =
        Renderer::create(context, package, **scene, rendererOptions(arguments, report));
    if (!renderer) {
        return renderer.error();
    }
    report.tracer = std::string(package::nameOf((*renderer)->tracer()));
    if ((strategyOf(arguments) & package::kOrderedStrategies) != 0) {
        report.ordering = std::string(package::nameOf((*renderer)->ordering()));
    }
    report.pipelineCreationMs = (*renderer)->pipelineCreationMs();
    report.footprint = (*renderer)->footprint();

    FrameOptions frame;
    frame.camera = camera;
    arguments.frame.apply(frame);
    arguments.effectFrame.apply(frame);
    frame.maxReflectionRoughness = static_cast<float>(arguments.effects.maxRoughness);
    frame.environment = environment;
    arguments.environment.apply(frame);
    frame.seed = report.seed;
    const Clock::time_point start = Clock::now();
    const auto addHits = [&]() -> Status {
        const Result<FrameCounters> counters = (*renderer)->counters();
        if (!counters) {
            return counters.error();
        }
        report.addHits(*counters);
        return okStatus();
    };
    const bool countsHits = !arguments.profileOutput.empty();
    Result<LinearImage> image =
        (*renderer)->render(frame, report.samples, countsHits ? addHits : std::function<Status()>());
    report.renderMs = millisecondsSince(start);
    if (!image) {
        return image;
    }
    Result<std::vector<PassTiming>> passes = (*renderer)->timings();
    if (!passes) {
        return passes.error();
    }
    Result<FrameCounters> counters = (*renderer)->counters();
    if (!counters) {
        return counters.error();
    }
    report.passes = std::move(*passes);
    report.counters = std::move(*counters);
    if (!arguments.coverage.empty()) {
        Result<std::vector<PixelPath>> paths = (*renderer)->readCoverage();
        if (!paths) {
            return paths.error();
        }
        report.paths = std::move(*paths);
    }
    return image;
}

// Error "validation" with the number of messages, each of which is reported.
Status checkValidation(const Console& console, const Context& context) {
    const std::vector<std::string> messages = context.validationMessages();
    for (const std::string& message : messages) {
        console.report(makeWarning("validation", "", message));
    }
    if (messages.empty()) {
        return okStatus();
    }
    return makeError("validation", "", fmt::format("the validation layers have {} messages", messages.size()),
                     "this is a defect of Glint or of the driver: please report it");
}

// A number that is none says more of the scene's own numbers than of the shaders.
void warnOfNonFinite(const Console& console, const RenderReport& report) {
    if (report.counters.nonFinite > 0) {
        console.report(makeWarning(
            "non-finite", report.scene,
            fmt::format("{} samples of pixels were no number and count as black", report.counters.nonFinite),
            "look for NaN, infinite or very large values among the scene's factors, colours and lights"));
    }
}

Status writeResults(const RenderArguments& arguments, const LinearImage& image, RenderReport& report) {
    report.exposure = automaticExposure(image);
    if (arguments.exposure != "auto") {
        parseReal(arguments.exposure, -kMaxExposure, kMaxExposure, report.exposure);
    }
    if (Status written = writeImage(arguments.output, image, report.exposure); !written) {
        return written;
    }
    if (!arguments.coverage.empty()) {
        const DisplayImage map = coverageMap(report.paths, report.width, report.height);
        if (Status written = writeImage(arguments.coverage, map); !written) {
            return written;
        }
    }
    return arguments.stats.empty() ? okStatus() : writeFile(arguments.stats, toText(toJson(report)));
}

// Everything between the scene and the files.
Status render(const Console& console, const RenderArguments& arguments, const SceneList& scenes,
              const PlanOptions& plan, RenderReport& report) {
    const Scene& scene = scenes.scenes().front();
    SceneViewData data = sceneView(arguments, scene);
    const double aspect = static_cast<double>(report.width) / report.height;
    const Result<CameraChoice> camera = chooseCamera(scene, data, arguments.camera, aspect);
    if (!camera) {
        return camera.error();
    }
    report.camera = camera->name;
    // Before the compilation, which takes longer than finding out that there is no device.
    const Result<std::unique_ptr<Context>> context = makeContext(arguments);
    if (!context) {
        return context.error();
    }
    report.device = (*context)->deviceName();
    report.driver = (*context)->driverName();
    const Result<std::unique_ptr<Environment>> environment =
        obtainEnvironment(console, arguments, **context, report);
    if (!environment) {
        return environment.error();
    }
    console.progress("compiling " + arguments.scene);
    const Result<Package> package =
        obtainPackage(console, arguments, plan, (*context)->handles().tracers, scene, report);
    if (!package) {
        return package.error();
    }
    data.packageScene = sceneIn(*package, scene).value_or(0);
    report.alpha = package->alphaTested() ? "tested" : "opaque";
    report.cases = package->caseCount();
    console.progress("rendering " + arguments.scene);
    const Result<LinearImage> image =
        renderFrame(**context, *package, data, environment->get(), arguments, camera->view, report);
    Status valid = checkValidation(console, **context);
    if (!image) {
        return image.error();
    }
    warnOfNonFinite(console, report);
    if (console.refused()) {
        return okStatus();
    }
    valid = valid ? checkOrder(report) : valid;
    Status done = valid ? writeResults(arguments, *image, report) : valid;
    if (!done || arguments.profileOutput.empty()) {
        return done;
    }
    std::vector<Diagnostic> warnings;
    done = writeProfile(arguments.profileOutput, scenes, plan, report.hits, warnings);
    console.report(warnings);
    return done;
}

int run(const Console& console, const RenderArguments& arguments) {
    RenderReport report;
    report.scene = arguments.scene;
    report.image = arguments.output;
    report.strategy = arguments.tracing.strategies.front();
    report.samples = static_cast<std::uint32_t>(arguments.samples);
    report.seed = static_cast<std::uint32_t>(arguments.seed);
    parseSize(arguments.size, report.width, report.height);

    Status status = checkOutputFile(arguments.output);
    for (const std::string& file : {arguments.stats, arguments.coverage, arguments.profileOutput}) {
        if (status && !file.empty()) {
            status = checkOutputFile(file);
        }
    }
    if (!status) {
        console.report(status.error());
        return kExitFailed;
    }
    console.progress("reading " + arguments.scene);
    ImportOptions import;
    import.decodeImages = true;
    import.variant = arguments.variant;
    const Result<Scene> scene = importScene(arguments.scene, import);
    if (!scene) {
        console.report(scene.error());
        return kExitFailed;
    }
    console.report(scene->warnings);
    const SceneList scenes({&*scene, 1});
    const Result<PlanChoice> plan = choosePlan(arguments.plan, scenes);
    if (!plan) {
        console.report(plan.error());
        return kExitFailed;
    }
    console.report(plan->warnings);
    console.report(plan->notes);
    if (console.refused()) {
        return kExitFailed;
    }
    status = render(console, arguments, scenes, plan->options, report);
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
        console.print(toText(report));
    }
    return kExitDone;
}

}  // namespace

void addRender(CLI::App& app, Action& chosen) {
    CLI::App& command =
        addCommand(app, "render", "Render a scene with its compiled shaders",
                   "glint render scene.gltf -o scene.png --size 1280x720 --spp 16 --strategy uber");
    const auto arguments = std::make_shared<RenderArguments>();
    addRenderOptions(command, arguments, [arguments, &chosen] {
        chosen = [arguments](const Console& console) { return run(console, *arguments); };
    });
}

}  // namespace glint

// glint render: a picture of a scene through the runtime.
#include "cli/camera.h"
#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/coverage.h"
#include "cli/environment.h"
#include "cli/plan_choice.h"
#include "cli/render_input.h"
#include "cli/render_profile.h"
#include "cli/render_report.h"
#include "cli/scene_view.h"
#include "cli/tracing_options.h"
#include "gltf/import.h"
#include "image/image_file.h"
#include "image/tone.h"

#include <glint/context.h>
#include <glint/package.h>
#include <glint/renderer.h>

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>

namespace glint {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kMaxExposure = 32.0;

struct RenderArguments {
    std::string scene;
    std::string output;
    TracingArguments tracing;
    FrameArguments frame;
    EnvironmentArguments environment;
    std::string variant;
    PlanArguments plan;
    AccuracyArguments accuracy;
    std::string package;
    std::string size = "960x540";
    std::int64_t samples = 1;
    std::int64_t seed = 0;
    std::string camera;
    std::string exposure = "auto";
    std::string sun = "auto";
    bool validate = false;
    std::string stats;
    std::string coverage;
    std::string profileOutput;  // counts hits by key; plan.profile is the file that planning reads
    std::string device;
    bool json = false;
};

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// "960x540"; false unless it is two numbers that checkImageSize() takes.
bool parseSize(const std::string& text, std::uint32_t& width, std::uint32_t& height) {
    const char* end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, width);
    if (first.ec != std::errc() || first.ptr == end || *first.ptr != 'x') {
        return false;
    }
    const auto second = std::from_chars(first.ptr + 1, end, height);
    return second.ec == std::errc() && second.ptr == end && checkImageSize(width, height, "").ok();
}

package::Strategy strategyOf(const RenderArguments& arguments) {
    return strategyNamed(arguments.tracing.strategies.front());
}

SceneViewData sceneView(const RenderArguments& arguments, const Scene& scene) {
    SceneViewData data = makeSceneView(scene);
    const bool isUnlit = scene.lights.empty() && arguments.environment.file.empty();
    if (arguments.sun == "on" || (arguments.sun == "auto" && isUnlit)) {
        data.lights.push_back(sunLight());
    }
    return data;
}

// The package that is asked for, checked, or one that is made now; fills in what the report says of it.
Result<Package> obtainPackage(const RenderArguments& arguments, const PlanOptions& plan,
                              std::uint32_t tracers, const Scene& scene, RenderReport& report) {
    if (!arguments.package.empty()) {
        Result<Package> package = Package::load(arguments.package);
        if (!package) {
            return package;
        }
        Status checked = checkPackage(*package, arguments.package, strategyOf(arguments),
                                      !arguments.environment.file.empty(), scene);
        return checked ? std::move(package) : Result<Package>(checked.error());
    }
    const Clock::time_point start = Clock::now();
    CompileSettings settings;
    arguments.tracing.apply(settings, tracers);
    settings.environmentMap = !arguments.environment.file.empty();
    settings.plan = plan;
    arguments.accuracy.apply(settings);
    Result<Package> package = compileTemporary(scene, settings);
    report.compileMs = millisecondsSince(start);
    report.merge = std::string(toString(plan.merge));
    return package;
}

Result<std::unique_ptr<Context>> makeContext(const RenderArguments& arguments) {
    HeadlessOptions options;
    options.validation = arguments.validate ? Validation::Synchronization : Validation::Off;
    options.deviceName = arguments.device;
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
    const std::string& tracer = arguments.tracing.tracers.front();
    if (tracer != "auto" && options.strategy != package::kStrategyHitShaders) {
        options.tracer = tracerNamed(tracer);
    }
    options.checkOrder = arguments.validate;
    arguments.frame.apply(options);
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
    report.ordering = std::string(package::nameOf((*renderer)->ordering()));
    report.pipelineCreationMs = (*renderer)->pipelineCreationMs();

    FrameOptions frame;
    frame.camera = camera;
    arguments.frame.apply(frame);
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
Status render(const Console& console, const RenderArguments& arguments, const Scene& scene,
              const PlanOptions& plan, RenderReport& report) {
    const SceneViewData data = sceneView(arguments, scene);
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
        obtainPackage(arguments, plan, (*context)->handles().tracers, scene, report);
    if (!package) {
        return package.error();
    }
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
    Status done = valid ? writeResults(arguments, *image, report) : valid;
    if (!done || arguments.profileOutput.empty()) {
        return done;
    }
    std::vector<Diagnostic> warnings;
    done = writeProfile(arguments.profileOutput, scene, plan, report.hits, warnings);
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
    const Result<PlanChoice> plan = choosePlan(arguments.plan, *scene);
    if (!plan) {
        console.report(plan.error());
        return kExitFailed;
    }
    console.report(plan->warnings);
    console.report(plan->notes);
    status = render(console, arguments, *scene, plan->options, report);
    if (!status) {
        console.report(status.error());
        return kExitFailed;
    }
    console.print(arguments.json ? toText(toJson(report)) : toText(report));
    return kExitDone;
}

void addPictureOptions(CLI::App& command, RenderArguments& arguments) {
    const std::string group = "Picture";
    addText(command, "--size", arguments.size, "WxH",
            "pixels, 1 to 16384 each way (default: " + arguments.size + ")")
        .check(CLI::Validator(
            [](const std::string& text) {
                std::uint32_t width = 0;
                std::uint32_t height = 0;
                return parseSize(text, width, height) ? std::string()
                                                      : "\"" + text + "\" is no size such as 960x540";
            },
            ""))
        ->group(group);
    addInteger(command, "--spp", arguments.samples, 1, 65536, "samples a pixel").group(group);
    addInteger(command, "--seed", arguments.seed, 0, 0xFFFFFFFFLL, "of the random numbers").group(group);
    addText(command, "--camera", arguments.camera, "NAME|INDEX|auto",
            "a camera of the scene by name or number from 0;\nauto: one that frames everything\n"
            "(default: the first of the scene, else auto)")
        .group(group);
    addText(command, "--exposure", arguments.exposure, "auto|EV",
            "stops, -32 to 32, of PNG files; auto: log-average luminance\nto 18 % grey (default: auto)")
        .check(CLI::Validator(
            [](const std::string& text) {
                double stops = 0.0;
                return text == "auto" || parseReal(text, -kMaxExposure, kMaxExposure, stops)
                           ? std::string()
                           : "\"" + text + "\" is neither auto nor a number from -32 to 32";
            },
            ""))
        ->group(group);
    addChoice(command, "--sun", arguments.sun, {"auto", "on", "off"},
              "add a directional light; auto: if the scene has no light\nand no --environment")
        .group(group);
}

void addDeviceOptions(CLI::App& command, RenderArguments& arguments) {
    addText(command, "--device", arguments.device, "NAME",
            "part of the GPU's name (default: the first that will do)")
        .group("Device");
    addFlag(command, "--validate", arguments.validate,
            "run with the Vulkan validation layers, synchronisation\nincluded; any message is an error")
        .group("Device");
    addText(command, "--stats", arguments.stats, "FILE.json", "write times and counters").group("Report");
    addImageOutput(command, "--coverage", arguments.coverage, {".png"},
                   "write how each pixel of the last sample came to its\n"
                   "reflection; orange: found in screen space; blue: by a\n"
                   "ray that hit; light blue: by a ray that missed; grey: no\n"
                   "ray; black: no surface")
        .group("Report");
    addText(command, "--profile", arguments.profileOutput, "FILE.json",
            "count the hits of every permutation, for the option\n"
            "--merge profile of compile; needs --merge none (here\n"
            "the default then) and --strategy visibility")
        .group("Report");
    addFlag(command, "--json", arguments.json, "print times and counters as JSON").group("Report");
}

}  // namespace

void addRender(CLI::App& app, Action& chosen) {
    auto arguments = std::make_shared<RenderArguments>();
    CLI::App& command =
        addCommand(app, "render", "Render a scene with its compiled shaders",
                   "glint render scene.gltf -o scene.png --size 1280x720 --spp 16 --strategy uber");
    addText(command, "SCENE", arguments->scene, "FILE", "the scene, .gltf or .glb").required();
    addVariant(command, arguments->variant);
    addImageOutput(command, "-o,--output", arguments->output, {".png", ".exr"},
                   "the picture; .png: exposed and tone mapped (Khronos PBR\nNeutral), 8-bit sRGB; .exr: "
                   "linear, 32-bit float")
        .required();
    addPictureOptions(command, *arguments);
    addEnvironmentOptions(command, arguments->environment);
    addFrameOptions(command, arguments->frame);
    const std::vector<CLI::Option*> placed = addTracingChoice(command, arguments->tracing);
    std::vector<CLI::Option*> decided = addPlanOptions(command, arguments->plan);
    for (CLI::Option* option : addAccuracyOptions(command, arguments->accuracy)) {
        decided.push_back(option);
    }
    decided.insert(decided.end(), placed.begin(), placed.end());
    addText(command, "--package", arguments->package, "DIR",
            "use this package of the scene instead of compiling it\n"
            "(excludes --merge, --max-shaders, --alpha, --hit-lobes,\n--energy-compensation, --texture-lod "
            "and --profile)")
        .group("Shaders");
    addDeviceOptions(command, *arguments);
    command.callback([arguments, decided, &chosen] {
        for (const CLI::Option* option : decided) {
            if (option->count() > 0 && !arguments->package.empty()) {
                throw CLI::ExcludesError(option->get_name(), "--package");
            }
        }
        settleProfileOutput(arguments->profileOutput, arguments->package,
                            arguments->tracing.strategies.front(), decided.front()->count() > 0,
                            arguments->plan);
        settleProfile(arguments->plan);
        chosen = [arguments](const Console& console) { return run(console, *arguments); };
    });
}

}  // namespace glint

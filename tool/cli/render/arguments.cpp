#include "cli/render/arguments.h"

#include "cli/options/settings_option.h"
#include "image/image_file.h"

#include <charconv>

namespace glint {

namespace {

constexpr double kMaxIntensity = 1e9;
constexpr const char* kMap = "--environment";
constexpr const char* kRotation = "--environment-rotation";
constexpr const char* kMapIntensity = "--environment-intensity";

void addEnvironmentOptions(CLI::App& command, measure::EnvironmentSettings& arguments) {
    const std::string group = "Environment";
    CLI::Option& file =
        addText(command, kMap, arguments.file, "FILE",
                "light the scene by this equirectangular map, .hdr or\n.exr, instead of a gradient");
    file.check(CLI::Validator(
                   [](const std::string& text) {
                       const Result<RadianceFormat> format = radianceFormat(text);
                       return format ? std::string() : "\"" + text + "\" does not end in .hdr or .exr";
                   },
                   ""))
        ->group(group);
    addReal(command, kRotation, arguments.rotation, -360.0, 360.0,
            "degrees about +Y, counter-clockwise as seen from above\n(-360 to 360, default: 0; needs "
            "--environment)")
        .group(group);
    addReal(command, kMapIntensity, arguments.intensity, 0.0, kMaxIntensity,
            "factor of the map's radiance (0 to 1e9, default: 1; needs\n"
            "--environment)")
        .group(group);
}

void checkEnvironmentOptions(const CLI::App& command) {
    for (const char* option : {kRotation, kMapIntensity}) {
        if (command.count(option) > 0 && command.count(kMap) == 0) {
            throw CLI::ValidationError(option, "needs --environment");
        }
    }
}

void addPictureOptions(CLI::App& command, RenderArguments& arguments) {
    const std::string group = "Picture";
    addText(command, "--size", arguments.size, "WxH",
            "pixels, 1 to 16384 each way, 67108864 in all\n(default: " + arguments.size + ")")
        .check(CLI::Validator(
            [](const std::string& text) {
                std::uint32_t width = 0;
                std::uint32_t height = 0;
                return measure::parseSize(text, width, height)
                           ? std::string()
                           : "\"" + text + "\" is no size such as 960x540";
            },
            ""))
        ->group(group);
    addInteger(command, "--spp", arguments.samples, 1, 65536, "samples per pixel").group(group);
    addInteger(command, "--seed", arguments.seed, 0, 0xFFFFFFFFLL, "seed of the random numbers").group(group);
    addText(command, "--camera", arguments.camera, "NAME|INDEX|auto",
            "a camera of the scene by name or number from 0;\nauto: one that frames everything\n"
            "(default: the first of the scene, else auto)")
        .group(group);
    addText(command, "--exposure", arguments.exposure, "auto|EV",
            "stops, -32 to 32, of PNG files; auto: log-average luminance\nof surfaces to 18 % grey (default: "
            "auto)")
        .check(CLI::Validator(
            [](const std::string& text) {
                double stops = 0.0;
                return text == "auto" || measure::parseReal(text, -kMaxExposure, kMaxExposure, stops)
                           ? std::string()
                           : "\"" + text + "\" is neither auto nor a number from -32 to 32";
            },
            ""))
        ->group(group);
    addText(command, "--sky", arguments.sky, "auto|FACTOR",
            "factor of the default sky's radiance, 0 to 1e9; auto: the\n"
            "sky brings as much light as the scene's lights, and the\n"
            "factor is 1 if the scene has none\n"
            "(default: auto; excludes --environment)")
        .check(CLI::Validator(
            [](const std::string& text) {
                double factor = 0.0;
                return text == "auto" || measure::parseReal(text, 0.0, measure::kMaxSky, factor)
                           ? std::string()
                           : "\"" + text + "\" is neither auto nor a number from 0 to 1e9";
            },
            ""))
        ->group(group);
    addChoice(command, "--sun", arguments.sun, {"auto", "on", "off"},
              "add a directional light; auto: only if the scene has no\n"
              "light and there is no --environment")
        .group(group);
}

void addDeviceOptions(CLI::App& command, RenderArguments& arguments) {
    addText(command, "--device", arguments.device, "NAME",
            "part of the GPU's name (default: the first that will do)")
        .group("Device");
    addFlag(command, "--validate", arguments.validate,
            "run with the Vulkan validation layers, synchronisation\nincluded: any message is an error; also "
            "checks the order\nof hits")
        .group("Device");
    addChoice(command, "--traversal-order", arguments.traversalOrder, {"auto", "input", "halving"},
              "how triangles and instances come in acceleration\n"
              "structures; input: as in the scene; halving: for drivers\n"
              "whose trees halve what they are given; auto: halving on\na CPU, input on a GPU")
        .group("Device");
    addPipelineOptions(command, arguments.pipelines, arguments.pipelineThreads);
}

void addRenderReports(CLI::App& command, RenderArguments& arguments) {
    addText(command, "--stats", arguments.stats, "FILE.json", "write times and counters as JSON")
        .group("Report");
    addFlag(command, "--pipeline-statistics", arguments.pipelineStatistics,
            "report what the driver says about each pipeline:\n"
            "registers, spills, instructions, or whatever it has")
        .group("Report");
    addImageOutput(command, "--coverage", arguments.coverage, {".png"},
                   "write how each pixel of the last sample came to its\n"
                   "reflection; orange: found in screen space; blue: by a\n"
                   "ray that hit; light blue: by a ray that missed; grey: no\n"
                   "ray; black: no surface")
        .group("Report");
    addText(command, "--profile", arguments.profileOutput, "FILE.json",
            "count the hits of every permutation, for --merge profile\n"
            "and auto; needs --strategy visibility; the default of\n"
            "--merge is then none, and no other value works")
        .group("Report");
}

// Hits are counted by case, so every key needs its own case, in a strategy that orders hits. Chooses --merge
// none. Throws a CLI::ParseError if the command line asks for something else. Does nothing if `file` is
// empty.
void settleProfileOutput(const std::string& file, const std::string& package, const std::string& strategy,
                         bool mergeGiven, measure::PlanSettings& plan) {
    if (file.empty()) {
        return;
    }
    if (!package.empty()) {
        throw CLI::ValidationError("--profile",
                                   "counts the shaders that --package decides; leave out one of them");
    }
    if (mergeGiven && plan.merge != "none") {
        throw CLI::ValidationError(
            "--profile",
            "counts the hits of every permutation, each of which needs a shader of its "
            "own: leave out --merge " +
                plan.merge);
    }
    if (strategy != "visibility") {
        throw CLI::ValidationError(
            "--profile", "needs --strategy visibility, which orders hits by shader, not " + strategy);
    }
    plan.merge = "none";
}

}  // namespace

std::vector<CLI::Option*> addSceneOptions(CLI::App& command, RenderArguments& arguments) {
    addText(command, "SCENE", arguments.scene, "FILE", "the scene, .gltf or .glb").required();
    addReadingOptions(command, arguments.reading);
    addSettingsFile(command, arguments.settings);
    addPictureOptions(command, arguments);
    addEnvironmentOptions(command, arguments.environment);
    CLI::Option& effects = addEffectOptions(command, arguments.effects);
    addEffectFrameOptions(command, arguments.effectFrame);
    addFrameOptions(command, arguments.frame);
    const std::vector<CLI::Option*> placed = addTracingChoice(command, arguments.tracing);
    addCalibration(command, arguments.calibration);
    std::vector<CLI::Option*> decided = addPlanOptions(command, arguments.plan);
    for (CLI::Option* option : addAccuracyOptions(command, arguments.accuracy)) {
        decided.push_back(option);
    }
    decided.insert(decided.end(), placed.begin(), placed.end());
    decided.push_back(&effects);
    addDeviceOptions(command, arguments);
    return decided;
}

void checkSceneOptions(const CLI::App& command, const RenderArguments& arguments) {
    checkEnvironmentOptions(command);
    if (command.count("--sky") > 0 && !arguments.environment.file.empty()) {
        throw CLI::ValidationError("--sky",
                                   "sets the sky that --environment replaces; leave out one of them");
    }
    checkTracingChoice(arguments.tracing);
    checkEffects(arguments.effects);
    checkEffectFrame(arguments.effectFrame);
}

void addRenderOptions(CLI::App& command, const std::shared_ptr<RenderArguments>& arguments,
                      const std::function<void()>& then) {
    addImageOutput(command, "-o,--output", arguments->output, {".png", ".exr"},
                   "the picture; .png: exposed and tone mapped (Khronos PBR\nNeutral), 8-bit sRGB; .exr: "
                   "linear, 32-bit float")
        .required();
    const std::vector<CLI::Option*> decided = addSceneOptions(command, *arguments);
    addMotionOptions(command, arguments->motion);
    addText(command, "--package", arguments->package, "DIR",
            "use this package of the scene instead of compiling it\n"
            "(excludes --merge, --max-shaders, --alpha, --hit-lobes,\n--energy-compensation, --texture-lod, "
            "--precision,\n--shadows, --hit-record, --effects and --profile)")
        .group("Shaders");
    addRenderReports(command, *arguments);
    command.callback([arguments, decided, then, &command] {
        for (const CLI::Option* option : decided) {
            if (option->count() > 0 && !arguments->package.empty()) {
                throw CLI::ValidationError(option->get_name(),
                                           "is decided by --package; leave out one of them");
            }
        }
        checkSceneOptions(command, *arguments);
        const bool plays = !arguments->motion.frames.empty() || !arguments->motion.time.empty();
        if (!plays && command.get_option("--animation")->count() > 0) {
            throw CLI::ValidationError("--animation", "needs --frames or --time; give one of them");
        }
        if (!arguments->motion.frames.empty() && !arguments->coverage.empty()) {
            throw CLI::ValidationError("--coverage", "shows one picture; leave out --frames, or use --time");
        }
        settleProfileOutput(arguments->profileOutput, arguments->package,
                            arguments->tracing.strategies.front(), decided.front()->count() > 0,
                            arguments->plan);
        settleProfile(arguments->plan);
        then();
    });
}

}  // namespace glint

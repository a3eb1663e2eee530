#include "cli/render/arguments.h"

#include "base/lists.h"
#include "base/text.h"
#include "cli/table.h"
#include "emit/compile.h"
#include "image/image_file.h"
#include "settings/settings.h"

#include <glint/measure/views.h>

#include <fmt/format.h>

#include <numeric>

namespace glint::cli {

// --- Movement ---

namespace {

constexpr std::int64_t kMaxFrame = 1000000;
constexpr double kMaxSeconds = 1e6;

std::string animationName(const gltf::Scene& scene, std::size_t index) {
    const std::string& name = scene.animations[index].name;
    return name.empty() ? std::to_string(index) : name;
}

std::optional<std::int64_t> parseFrame(std::string_view text) {
    std::int64_t frame = 0;
    return compiler::parseWhole(text, 0, kMaxFrame, frame) ? std::optional(frame) : std::nullopt;
}

Result<std::vector<std::size_t>> chooseAnimations(const gltf::Scene& scene, const std::string& wanted,
                                                  bool followsTime) {
    std::vector<std::size_t> all(scene.animations.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    if (all.empty() && followsTime) {
        return all;
    }
    if (all.empty()) {
        return makeError("animation-missing", scene.path, "has no animation to play",
                         "leave out --frames and --time");
    }
    if (wanted == "all") {
        return all;
    }
    for (const std::size_t index : all) {
        if (scene.animations[index].name == wanted) {
            return std::vector{index};
        }
    }
    const std::optional<std::int64_t> number = parseFrame(wanted);
    if (number && static_cast<std::size_t>(*number) < all.size()) {
        return std::vector{static_cast<std::size_t>(*number)};
    }
    std::vector<std::string> names =
        base::mapped<std::string>(all, [&](std::size_t index) { return animationName(scene, index); });
    const std::string known = base::enumeration(names);
    names.emplace_back("all");
    return makeError("animation-unknown", scene.path,
                     "has no animation \"" + wanted + "\"" + known + base::suggestion(wanted, names),
                     "use a name, a number from 0, or all");
}

}  // namespace

void addMotionOptions(CLI::App& command, MotionArguments& arguments) {
    const OptionGroup group(command, "Movement");
    CLI::Option& frames = addText(
        command, "--frames", arguments.frames, "A:B",
        "play an animation and write frames A to B, or one frame; each as out.0007.png, in place of an "
        "existing file",
        [](const std::string& text) {
            return parseFrames(text) ? std::string()
                                     : "\"" + text + "\" is neither a frame such as 7 nor a range such as " +
                                           "0:23; give one, of 0 to 1000000";
        });
    addReal(command, "--fps", arguments.fps, 0.001, 10000.0,
            "frames per second (0.001 to 10000, default: 24; needs --frames)")
        .needs(&frames);
    addMoment(command, arguments, "render one picture");
    command.get_option("--time")->excludes(&frames);
    addNamed(command, "--refit", arguments.builds,
             "how acceleration structures follow; auto: they are refitted, and rebuilt by rule; always: only "
             "refitted; never: rebuilt in each frame; needs --frames")
        .needs(&frames);
}

void addMoment(CLI::App& command, MotionArguments& arguments, const std::string& what) {
    addText(command, "--time", arguments.time, "SECONDS",
            what + " at this time of the animation (0 to 1000000, default: the rest pose)",
            [](const std::string& text) {
                double seconds = 0.0;
                return compiler::parseReal(text, 0.0, kMaxSeconds, seconds)
                           ? std::string()
                           : "\"" + text + "\" is no number from 0 to 1000000; give one";
            });
    addText(command, "--animation", arguments.animation, "NAME|INDEX|all",
            "which animation plays, by name or number from 0; all: all of them at once (default: 0)");
}

std::optional<FrameRange> parseFrames(const std::string& text) {
    const std::size_t colon = text.find(':');
    const std::string_view all = text;
    const std::optional<std::int64_t> first = parseFrame(all.substr(0, colon));
    const std::optional<std::int64_t> last =
        colon == std::string::npos ? first : parseFrame(all.substr(colon + 1));
    if (!first || !last || *last < *first) {
        return std::nullopt;
    }
    return FrameRange{*first, *last};
}

Result<std::optional<Movement>> chooseMovement(const MotionArguments& arguments, const gltf::Scene& scene,
                                               bool followsTime) {
    if (arguments.frames.empty() && arguments.time.empty()) {
        return std::optional<Movement>();
    }
    GLINT_TRY(auto animations, chooseAnimations(scene, arguments.animation, followsTime));
    Movement movement;
    movement.animations = std::move(animations);
    if (const std::optional<FrameRange> range = parseFrames(arguments.frames)) {
        movement.isSequence = true;
        movement.firstFrame = range->first;
        for (std::int64_t frame = range->first; frame <= range->last; ++frame) {
            movement.seconds.push_back(static_cast<double>(frame) / arguments.fps);
        }
    } else {
        double seconds = 0.0;
        compiler::parseReal(arguments.time, 0.0, kMaxSeconds, seconds);
        movement.seconds.push_back(seconds);
    }
    movement.builds = arguments.builds;
    return std::optional(std::move(movement));
}

std::filesystem::path numberedFile(const std::filesystem::path& file, std::int64_t frame) {
    std::filesystem::path numbered = file;
    numbered.replace_extension(fmt::format(".{:04}{}", frame, file.extension().string()));
    return numbered;
}

// --- The command line ---

namespace {

// Returns the names of the strategies that count the hits of each case.
std::string countingStrategies() {
    return fmt::format(
        "{}",
        fmt::join(compiler::strategyNames(package::strategiesThat(&package::StrategyInfo::dispatchesCases)),
                  " or "));
}

constexpr const char* kMap = "--environment";
constexpr const char* kRotation = "--environment-rotation";
constexpr const char* kMapIntensity = "--environment-intensity";

void addEnvironmentOptions(CLI::App& command, compiler::Settings& settings) {
    addText(command, kMap, settings.environment, "FILE",
            "light the scene by this equirectangular map; a .hdr or .exr file, instead of a gradient",
            [](const std::string& text) {
                const Result<image::RadianceFormat> format = image::radianceFormat(text);
                return format ? std::string()
                              : "\"" + text + "\" does not end in .hdr or .exr; name such a file";
            })
        .group("Environment");
}

void checkEnvironmentOptions(const CLI::App& command) {
    for (const char* option : {kRotation, kMapIntensity}) {
        if (command.count(option) > 0 && command.count(kMap) == 0) {
            throw CLI::ValidationError(option, "needs --environment; give both, or neither");
        }
    }
}

void addPictureOptions(CLI::App& command, RenderArguments& arguments) {
    const OptionGroup group(command, "Picture");
    addText(command, "--camera", arguments.camera, "NAME|INDEX|auto|PLACE",
            "a camera of the scene by name or number from 0; auto: one that frames everything; PLACE: "
            "position, target and vertical field of view in degrees, such as 1.5,2,3/0,0.5,0/30 (default: "
            "the first of the scene, else auto)");
    addText(command, "--exposure", arguments.exposure, "auto|EV",
            fmt::format("stops, {0:g} to {1:g}, of PNG files; auto: log-average luminance of surfaces to 18 "
                        "% grey (default: auto)",
                        -kMaxExposure, kMaxExposure),
            [](const std::string& text) {
                double stops = 0.0;
                return text == "auto" || compiler::parseReal(text, -kMaxExposure, kMaxExposure, stops)
                           ? std::string()
                           : fmt::format("\"{}\" is neither auto nor a number from {:g} to {:g}; give one",
                                         text, -kMaxExposure, kMaxExposure);
            });
}

void addDeviceOptions(CLI::App& command, RenderArguments& arguments) {
    const OptionGroup group(command, "Device");
    addDeviceChoice(command, arguments.device, arguments.validate, "; also checks the order of hits");
    addPipelineOptions(command, arguments.pipelines);
    addJobs(command, arguments.compile.jobs);
    addCacheOptions(command, arguments.cache);
}

constexpr const char* kView = "--view";
constexpr const char* kViewReference = "--view-reference";

std::vector<std::string> viewNames() {
    return base::mapped<std::string>(measure::viewTable(), &measure::ViewInfo::name);
}

// Says what is wrong with a text that names no view.
std::string complaintAboutView(const std::string& text) {
    const std::size_t dot = text.find('.');
    const std::string name = dot == std::string::npos ? text : text.substr(dot + 1);
    if (measure::findView(name) != nullptr && dot > 0) {
        return fmt::format("\"{}\" is no view, because {} is not about the rays of one effect; use {}", text,
                           name, name);
    }
    const std::string suggestion = base::suggestion(name, viewNames());
    return fmt::format("\"{}\" is no view{}", text,
                       suggestion.empty() ? "; --help-all lists them" : suggestion);
}

void addViewOptions(CLI::App& command, RenderArguments& arguments) {
    const OptionGroup group(command, "Picture");
    addText(command, kView, arguments.view, "NAME",
            fmt::format(
                "write a debug picture instead, with a legend below it, and its numbers into --stats: {}; "
                "EFFECT.NAME for the rays of another effect than the first (docs/views.md)",
                base::join(viewNames())),
            [](const std::string& text) {
                return measure::parseView(text) ? std::string() : complaintAboutView(text);
            });
    addText(command, kViewReference, arguments.viewReference, "FILE",
            "the picture that --view difference compares with, .exr or .png; an .exr of --spp 1024 is a good "
            "one");
}

// Throws a CLI::ParseError if the line contradicts itself about views.
void checkView(const CLI::App& command, const RenderArguments& arguments) {
    const std::optional<measure::ViewChoice> view = measure::parseView(arguments.view);
    const bool compares = view && view->info->readsReference;
    if (command.count(kViewReference) > 0 && !compares) {
        throw CLI::ValidationError(kViewReference, "needs --view difference; give both, or neither");
    }
    if (!view) {
        return;
    }
    if (compares && arguments.viewReference.empty()) {
        throw CLI::ValidationError(kView,
                                   "difference needs a picture to compare with; give --view-reference FILE");
    }
    const Result<image::ImageFormat> format = image::imageFormat(arguments.output);
    if (format && *format != image::ImageFormat::Png) {
        const std::vector<std::string> layers = measure::layersFor(*view);
        throw CLI::ValidationError(
            kView,
            layers.empty()
                ? std::string("is drawn into a PNG file; give -o FILE.png")
                : fmt::format("is drawn into a PNG file; give -o FILE.png, or for the numbers --layers {} "
                              "and no view",
                              fmt::join(layers, ",")));
    }
}

// Throws a CLI::ParseError if the line contradicts itself about denoising.
void checkDenoising(const RenderArguments& arguments) {
    if (arguments.denoise && !arguments.view.empty()) {
        throw CLI::ValidationError("--denoise",
                                   "changes the picture that --view replaces; leave out one of them");
    }
}

void addRenderReports(CLI::App& command, RenderArguments& arguments) {
    const OptionGroup group(command, "Report");
    addOutputFile(command, "--stats", arguments.stats, "FILE.json", {}, "write times and counters as JSON");
    addFlag(command, "--pipeline-statistics", arguments.pipelineStatistics,
            "report the driver's statistics of each pipeline, such as registers, spills and instructions");
    addOutputFile(
        command, "--coverage", arguments.coverage, "FILE.png", {".png"},
        "write how each pixel of the last sample got its reflection; orange: found in screen space; blue: "
        "by a ray that hit; light blue: by a ray that missed; grey: no ray; black: no surface");
    addOutputFile(command, "--profile", arguments.profileOutput, "FILE.json", {},
                  "count the hits of every permutation, for --merge profile and auto; needs --strategy " +
                      countingStrategies() +
                      "; the default of --merge is then none, and no other value works");
}

// Hits are counted by case, so every key needs its own case, in a strategy that orders hits. Throws a
// CLI::ParseError if the command line asks for something else. Does nothing unless hits are counted.
void checkProfileOutput(const CLI::App& command, const RenderArguments& arguments) {
    if (arguments.profileOutput.empty()) {
        return;
    }
    if (!arguments.package.empty()) {
        throw CLI::ValidationError("--profile",
                                   "counts the shaders that --package decides; leave out one of them");
    }
    if (command.count("--merge") > 0 && arguments.compile.plan.merge != compiler::MergePolicy::None) {
        throw CLI::ValidationError("--profile",
                                   "counts the hits of every permutation, each of which needs a shader of "
                                   "its own; leave out --merge " +
                                       command.get_option("--merge")->results().front());
    }
    if (!arguments.strategy || !package::infoOf(*arguments.strategy).dispatchesCases) {
        throw CLI::ValidationError(
            "--profile", "can't count with --strategy " +
                             compiler::sweptSetting("strategy")->values.text(arguments) +
                             ", which does not order hits by shader; use --strategy " + countingStrategies());
    }
}

}  // namespace

void checkPackageChoice(const CLI::App& command) {
    if (command.count("--package") == 0) {
        return;
    }
    if (command.count("--host") > 0) {
        throw CLI::ValidationError("--host", "is decided by --package; leave out one of them");
    }
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        const std::string option = "--" + std::string(row.name);
        const bool isDecided =
            (row.commands & compiler::kOfRender) != 0 && row.stage == compiler::SettingStage::Package;
        if (isDecided && command.count(option) > 0) {
            throw CLI::ValidationError(option, "is decided by --package; leave out one of them");
        }
    }
}

void addPackageOption(CLI::App& command, RenderArguments& arguments, const std::string& further) {
    addText(command, "--package", arguments.package, "DIR",
            "use this package of the scene instead of compiling it" + further +
                " (excludes --host, --profile, and all settings that are decided for the package: "
                "docs/cli.md)")
        .group("Shaders");
}

void addSceneOptions(CLI::App& command, RenderArguments& arguments) {
    addText(command, "SCENE", arguments.scene, "FILE", "the scene, .gltf or .glb").required();
    addReadingOptions(command, arguments);
    addSettingsFile(command, arguments.settingsFile);
    addPictureOptions(command, arguments);
    addEnvironmentOptions(command, arguments);
    addSettings(command, compiler::kOfRender, arguments);
    addCalibration(command, arguments);
    addHostOption(command, arguments);
    addDeviceOptions(command, arguments);
}

void checkSceneOptions(const CLI::App& command, RenderArguments& arguments) {
    checkEnvironmentOptions(command);
    if (command.count("--sky") > 0 && !arguments.environment.empty()) {
        throw CLI::ValidationError("--sky",
                                   "sets the sky that --environment replaces; leave out one of them");
    }
    checkSettings(command, arguments);
}

void addRenderOptions(CLI::App& command, const std::shared_ptr<RenderArguments>& arguments,
                      const std::function<void()>& then) {
    addOutputFile(
        command, "-o,--output", arguments->output, "IMAGE", {".png", ".exr"},
        "the picture, a .png or .exr file; .png: exposed and tone mapped (Khronos PBR Neutral), 8-bit sRGB; "
        ".exr: linear, 32-bit float")
        .required();
    addSceneOptions(command, *arguments);
    addMotionOptions(command, arguments->motion);
    addText(
        command, "--edits", arguments->edits, "FILE.json",
        "edit the scene while it is drawn: hide, move, delete, copy nodes, change materials and lights, add "
        "glTF files; each edit before a frame, all of them without --frames (docs/live.md)")
        .group("Movement");
    addPackageOption(command, *arguments);
    addFlag(command, "--denoise", arguments->denoise,
            "remove the noise of each picture; by Open Image Denoise, if glint was built with it "
            "(docs/layers.md)")
        .group("Picture");
    addViewOptions(command, *arguments);
    addRenderReports(command, *arguments);
    command.callback([arguments, then, &command] {
        checkPackageChoice(command);
        checkSceneOptions(command, *arguments);
        const bool plays = !arguments->motion.frames.empty() || !arguments->motion.time.empty();
        if (!plays && command.count("--animation") > 0) {
            throw CLI::ValidationError("--animation", "needs --frames or --time; give one of them");
        }
        if (!arguments->motion.frames.empty() && !arguments->coverage.empty()) {
            throw CLI::ValidationError("--coverage", "shows one picture; leave out --frames, or use --time");
        }
        const Result<image::ImageFormat> format = image::imageFormat(arguments->output);
        if (!arguments->compile.layers.empty() && format && *format != image::ImageFormat::Exr) {
            throw CLI::ValidationError("--layers", "needs a file that has room for layers; give -o FILE.exr");
        }
        checkView(command, *arguments);
        checkDenoising(*arguments);
        checkProfileOutput(command, *arguments);
        checkProfile(command, *arguments);
        then();
    });
}

}  // namespace glint::cli

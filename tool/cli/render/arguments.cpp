#include "cli/render/arguments.h"

#include "base/text.h"
#include "cli/options/options.h"
#include "cli/options/setting_options.h"
#include "cli/table.h"
#include "emit/compile.h"
#include "image/image_file.h"

#include <glint/measure/views.h>

#include <fmt/format.h>

namespace glint::cli {

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
            "light the scene by this equirectangular map; a .hdr or .exr\n"
            "file, instead of a gradient")
        .check(CLI::Validator(
            [](const std::string& text) {
                const Result<image::RadianceFormat> format = image::radianceFormat(text);
                return format ? std::string()
                              : "\"" + text + "\" does not end in .hdr or .exr; name such a file";
            },
            ""))
        ->group("Environment");
}

void checkEnvironmentOptions(const CLI::App& command) {
    for (const char* option : {kRotation, kMapIntensity}) {
        if (command.count(option) > 0 && command.count(kMap) == 0) {
            throw CLI::ValidationError(option, "needs --environment; give both, or neither");
        }
    }
}

void addPictureOptions(CLI::App& command, RenderArguments& arguments) {
    const std::string group = "Picture";
    addText(command, "--camera", arguments.camera, "NAME|INDEX|auto|PLACE",
            "a camera of the scene by name or number from 0;\nauto: one that frames everything; PLACE: "
            "position,\n"
            "target and vertical field of view in degrees, such as\n1.5,2,3/0,0.5,0/30\n"
            "(default: the first of the scene, else auto)")
        .group(group);
    addText(command, "--exposure", arguments.exposure, "auto|EV",
            fmt::format("stops, {0:g} to {1:g}, of PNG files; auto: log-average luminance\n"
                        "of surfaces to 18 % grey (default: auto)",
                        -kMaxExposure, kMaxExposure))
        .check(CLI::Validator(
            [](const std::string& text) {
                double stops = 0.0;
                return text == "auto" || compiler::parseReal(text, -kMaxExposure, kMaxExposure, stops)
                           ? std::string()
                           : fmt::format("\"{}\" is neither auto nor a number from {:g} to {:g}; give one",
                                         text, -kMaxExposure, kMaxExposure);
            },
            ""))
        ->group(group);
}

void addDeviceOptions(CLI::App& command, RenderArguments& arguments) {
    addDeviceChoice(command, arguments.device, arguments.validate, "; also checks the order of hits");
    addPipelineOptions(command, arguments.pipelines);
    addJobs(command, arguments.compile.jobs);
    addCacheOptions(command, arguments.cache);
}

constexpr const char* kView = "--view";
constexpr const char* kViewReference = "--view-reference";

// "shader, key, …", over several lines.
std::string viewNames() {
    constexpr std::size_t kWidth = 50;
    std::string text;
    std::size_t line = 0;
    for (const measure::ViewInfo& view : measure::viewTable()) {
        const std::string_view separator = text.empty()                       ? ""
                                           : line + view.name.size() > kWidth ? ",\n"
                                                                              : ", ";
        line = separator == ",\n" ? 0 : line;
        text += fmt::format("{}{}", separator, view.name);
        line += view.name.size() + 2;
    }
    return text;
}

// Says what is wrong with a text that names no view.
std::string complaintAboutView(const std::string& text) {
    const std::size_t dot = text.find('.');
    const std::string name = dot == std::string::npos ? text : text.substr(dot + 1);
    if (measure::findView(name) != nullptr && dot > 0) {
        return fmt::format("\"{}\" is no view, because {} is not about the rays of one effect; use {}", text,
                           name, name);
    }
    std::vector<std::string> known;
    for (const measure::ViewInfo& view : measure::viewTable()) {
        known.emplace_back(view.name);
    }
    const std::string suggestion = base::suggestion(name, known);
    return fmt::format("\"{}\" is no view{}", text,
                       suggestion.empty() ? "; --help-all lists them" : suggestion);
}

void addViewOptions(CLI::App& command, RenderArguments& arguments) {
    addText(command, kView, arguments.view, "NAME",
            "write a debug picture instead, with a legend below it, and\nits numbers into --stats:\n" +
                viewNames() + ";\nEFFECT.NAME for the rays of another effect than the first\n(docs/views.md)")
        .check(CLI::Validator(
            [](const std::string& text) {
                return measure::parseView(text) ? std::string() : complaintAboutView(text);
            },
            ""))
        ->group("Picture");
    addText(command, kViewReference, arguments.viewReference, "FILE",
            "the picture that --view difference compares with, .exr or\n.png; an .exr of --spp 1024 is a "
            "good one")
        .group("Picture");
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
    addOutputFile(command, "--stats", arguments.stats, "FILE.json", {}, "write times and counters as JSON")
        .group("Report");
    addFlag(command, "--pipeline-statistics", arguments.pipelineStatistics,
            "report the driver's statistics of each pipeline, such as\n"
            "registers, spills and instructions")
        .group("Report");
    addOutputFile(
        command, "--coverage", arguments.coverage, "FILE.png", {".png"},
        "write how each pixel of the last sample got its reflection; orange: found in screen space; blue: "
        "by a ray that hit; light blue: by a ray that missed; grey: no ray; black: no surface")
        .group("Report");
    addOutputFile(command, "--profile", arguments.profileOutput, "FILE.json", {},
                  "count the hits of every permutation, for --merge profile and auto; needs --strategy " +
                      countingStrategies() +
                      "; the default of --merge is then none, and no other value works")
        .group("Report");
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
            wrapped("use this package of the scene instead of compiling it" + further +
                        " (excludes --host, --profile, and all settings that are decided for the package: "
                        "docs/cli.md)",
                    kHelpColumns))
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
    addPackageOption(command, *arguments);
    addFlag(command, "--denoise", arguments->denoise,
            "remove the noise of each picture; by Open Image Denoise, if\n"
            "glint was built with it (docs/layers.md)")
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

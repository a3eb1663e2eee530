#include "cli/bench/arguments.h"

#include "base/text.h"
#include "cli/bench/denoise_filter.h"
#include "cli/options/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace glint::cli {

namespace {

constexpr std::int64_t kRounds = 11;
constexpr std::int64_t kQuickRounds = 6;  // the fewest with a confidence interval of 95 %
constexpr double kReferenceError = 0.005;
constexpr double kQuickReferenceError = 0.04;
constexpr std::int64_t kReferenceSamples = 16384;
constexpr std::int64_t kQuickReferenceSamples = 768;
constexpr const char* kQuickSize = "80x45";
constexpr const char* kDenoise = "denoise";  // of --only; it is no setting

// These options decide about the picture, but no bench sweeps them. A point's command includes those that
// were given.
bool isView(const CLI::Option& option) {
    constexpr std::string_view kViews[] = {"--camera",       "--environment", "--scene", "--variant",
                                           "--strict-paths", "--materials",   "--host",  "--device"};
    const std::string name = option.get_name();
    return std::ranges::find(kViews, name) != std::end(kViews) ||
           std::ranges::any_of(compiler::settingsTable(), [&](const compiler::Descriptor& row) {
               return name == "--" + std::string(row.name) && (row.commands & compiler::kOfRender) != 0 &&
                      row.bench.use == compiler::BenchUse::View;
           });
}

// Parses NAME=DIR of --candidate.
measure::Candidate parseCandidate(const std::string& text) {
    const std::size_t sign = text.find('=');
    if (sign == std::string::npos || sign == 0 || sign + 1 == text.size()) {
        throw CLI::ValidationError("--candidate",
                                   "\"" + text + "\" is not NAME=DIR; give one, such as mine=out/package");
    }
    return {text.substr(0, sign), text.substr(sign + 1)};
}

void addSweepOptions(CLI::App& command, BenchArguments& arguments) {
    const std::string sweep = "Sweep";
    addFlag(command, "--quick", arguments.quick,
            fmt::format("fewer values, pairs and rounds; a less certain reference,\n"
                        "and {} unless --size is given",
                        kQuickSize))
        .group(sweep);
    addChoice(command, "--depth", arguments.depth, {"singles", "pairs", "search"},
              "how far the sweep goes; singles: one setting at a time;\n"
              "pairs: then the pairs that matter; search: then a search\n"
              "for the Pareto front")
        .group(sweep);
    std::vector<std::string> parts = compiler::settingNames();
    parts.emplace_back(kDenoise);
    addChoices(command, "--only", arguments.only, parts,
               "sweep only these settings, separated by commas (default:\n"
               "all); denoise: the picture filtered by examples/denoise,\n"
               "beside one of 64 samples")
        .type_name("LIST")
        ->group(sweep);
    addInteger(command, "--rounds", arguments.rounds, 0, 1000,
               fmt::format("pictures of each configuration, each with other random\n"
                           "numbers; 0: {}, or {} with --quick or --calibrate",
                           kRounds, kQuickRounds))
        .group(sweep);
    addInteger(command, "--batch", arguments.batch, 1, 64,
               "configurations on the device at a time, besides the one\n"
               "with which all are compared")
        .group(sweep);
    addTexts(command, "--candidate", arguments.candidateWords, "NAME=DIR",
             "measure this package of the scene, too; may be repeated")
        .allow_extra_args(false)
        ->group(sweep);
}

void addErrorOptions(CLI::App& command, BenchArguments& arguments) {
    const std::string errors = "Errors";
    addChoice(command, "--metric", arguments.metric, {"relMse", "trimmed", "rmse", "flip"},
              "the error by which configurations are ordered; trimmed:\n"
              "relMSE without the worst 0.1 % of pixels, so that\n"
              "fireflies do not decide")
        .group(errors);
    addChoice(command, "--reference", arguments.reference, {"full", "same"},
              "what errors are measured against; full: all of light\n"
              "transport, that is unlimited bounces, effects that send\n"
              "rays wherever light comes from, and so on; same: the\n"
              "effects and bounces of the default")
        .group(errors);
    addReal(command, "--reference-error", arguments.referenceError, 0.0, 1.0,
            fmt::format("relative error that the reference itself may have; 0: {},\n"
                        "or {} with --quick (0 to 1, default: 0)",
                        kReferenceError, kQuickReferenceError))
        .group(errors);
    addInteger(command, "--reference-spp", arguments.referenceSamples, 0, 1 << 24,
               fmt::format("the most samples per pixel of the reference; 0: {}, or\n"
                           "{} with --quick",
                           kReferenceSamples, kQuickReferenceSamples))
        .group(errors);
    const std::string advice = "Advice";
    addReal(command, "--budget-ms", arguments.budgetMs, 0.0, 1e9,
            "write the most exact settings within this time; to\nDIR/settings.json, by the time of a picture "
            "(0 to "
            "1e9)")
        .group(advice);
    addReal(command, "--max-error", arguments.maxError, 0.0, 1e9,
            "write the fastest settings with at most this error; in the\nmetric (0 to 1e9)")
        .group(advice);
}

}  // namespace

void addBenchOptions(CLI::App& command, BenchArguments& arguments) {
    // settleBench() replaces 0 by a value that depends on --quick.
    arguments.rounds = 0;
    arguments.referenceError = 0.0;
    arguments.referenceSamples = 0;
    arguments.render.renderer.width = 480;
    arguments.render.renderer.height = 270;
    arguments.render.samples = 4;
    addText(command, "-o,--output", arguments.output, "DIR",
            "folder of the results; index.html, bench.json,\n"
            "settings.json and images/, with --calibrate\n"
            "calibration.json; those of an earlier run are replaced, and\n"
            "any other content refused; required but for --device-report");
    addSceneOptions(command, arguments.render);
    // Without --calibrate, checkCalibrateOptions() requires it.
    command.get_option("SCENE")->required(false)->description(
        "the scene, .gltf or .glb; none with --calibrate, optional\nwith --device-report");
    addSweepOptions(command, arguments);
    addErrorOptions(command, arguments);
    addCalibrateOptions(command, arguments.calibrate);
}

void settleBench(const CLI::App& command, BenchArguments& arguments) {
    checkCalibrateOptions(command, arguments.calibrate);
    checkSceneOptions(command, arguments.render);
    checkProfile(command, arguments.render);
    for (const char* const name : {"--budget-ms", "--max-error"}) {
        const CLI::Option* const option = command.get_option(name);
        if (option->count() > 0 && !(option->as<double>() > 0.0)) {
            throw CLI::ValidationError(name, "no setting can reach 0; give a larger number");
        }
    }
    if (std::ranges::find(arguments.only, kDenoise) != arguments.only.end()) {
        arguments.filter = exampleFilter();
        if (arguments.filter == nullptr) {
            throw CLI::ValidationError("--only",
                                       "denoise needs a glint that was built with its examples; build it "
                                       "with -DGLINT_BUILD_EXAMPLES=ON");
        }
    }
    for (const std::string& text : arguments.candidateWords) {
        arguments.candidates.push_back(parseCandidate(text));
    }
    if (arguments.rounds == 0) {
        const bool isShort = !arguments.calibrate.deviceReport.empty() && arguments.quick;
        arguments.rounds = isShort                                          ? 1
                           : arguments.quick || arguments.calibrate.enabled ? kQuickRounds
                                                                            : kRounds;
    }
    if (arguments.referenceError == 0.0) {
        arguments.referenceError = arguments.quick ? kQuickReferenceError : kReferenceError;
    }
    if (arguments.referenceSamples == 0) {
        arguments.referenceSamples = arguments.quick ? kQuickReferenceSamples : kReferenceSamples;
    }
    std::vector<std::string> words{"glint", "bench"};
    for (const CLI::Option* const option : command.get_options()) {
        if (option->count() == 0 || !hasEffect(*option)) {
            continue;
        }
        addWords(*option, words);
        if (isView(*option)) {
            addWords(*option, arguments.viewWords);
        }
    }
    arguments.command = base::shellWords(words);
    if (command.get_option("--size")->count() == 0) {
        RendererOptions& renderer = arguments.render.renderer;
        if (arguments.quick) {
            compiler::parseSize(kQuickSize, renderer.width, renderer.height);
        }
        arguments.viewWords.insert(arguments.viewWords.end(),
                                   {"--size", fmt::format("{}x{}", renderer.width, renderer.height)});
    }
}

}  // namespace glint::cli

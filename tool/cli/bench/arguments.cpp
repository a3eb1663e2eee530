#include "base/lists.h"
#include "base/text.h"
#include "cli/bench/bench.h"
#include "cli/options/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

namespace glint::cli {

namespace {

constexpr const char* kGroup = "Calibration";
constexpr std::uint64_t kThousand = 1000;
constexpr std::uint64_t kMillion = 1000000;
constexpr std::uint64_t kMinRays = 1024;
// The limit is that of checkImageSize() for the picture that sends the rays.
constexpr std::uint64_t kMaxRays = 64 * kMillion;

// A calibration takes the options of these groups, and the options listed below. It decides everything else
// itself.
constexpr const char* kDeviceReport = "--device-report";
// A report of the device takes a scene, and these besides the options of a calibration that are no settings.
constexpr std::string_view kOfDeviceReport[] = {kDeviceReport, "SCENE", "--quick", "--rounds", "--seed"};
constexpr std::string_view kTakenGroups[] = {kGroup, "Device", "Output", "Report", kWork};
constexpr std::string_view kTaken[] = {
    "--quick",       "--rounds",    "--output",     "--seed",
    "--binning",     "--ordering",  "--tracer",     "--energy-compensation",
    "--texture-lod", "--precision", "--hit-record", "--position-fetch",
    "--shadows"};

// Parses "250", "16k" or "1M". Returns nothing for other text.
std::optional<std::uint64_t> parseCount(std::string_view text) {
    std::uint64_t factor = 1;
    if (text.ends_with('k') || text.ends_with('M')) {
        factor = text.ends_with('k') ? kThousand : kMillion;
        text.remove_suffix(1);
    }
    std::uint64_t count = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), count);
    const bool whole = parsed.ec == std::errc() && parsed.ptr == text.data() + text.size();
    return whole && count <= kMaxRays ? std::optional(count * factor) : std::nullopt;
}

// Returns the numbers in ascending order without duplicates, or nothing unless all are within [min, max].
std::optional<std::vector<std::uint64_t>> parseCounts(const std::string& text, std::uint64_t min,
                                                      std::uint64_t max) {
    std::vector<std::uint64_t> counts;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::optional<std::uint64_t> count =
            parseCount(std::string_view(text).substr(begin, end - begin));
        if (!count || *count < min || *count > max) {
            return std::nullopt;
        }
        counts.push_back(*count);
        begin = end + 1;
    }
    std::ranges::sort(counts);
    counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
    return counts;
}

void addCounts(CLI::App& command, const std::string& flags, std::string& value, std::uint64_t min,
               std::uint64_t max, const std::string& help) {
    addText(command, flags, value, "auto|LIST", help, [min, max](const std::string& text) {
        return text == "auto" || parseCounts(text, min, max)
                   ? std::string()
                   : fmt::format("\"{}\" is neither auto nor a list of numbers from {} to {}; give one", text,
                                 min, max);
    });
}

bool isTaken(const CLI::Option& option) {
    return std::ranges::find(kTakenGroups, option.get_group()) != std::end(kTakenGroups) ||
           std::ranges::find(kTaken, option.get_name()) != std::end(kTaken);
}

bool isOfDeviceReport(const CLI::Option& option) {
    const std::string& group = option.get_group();
    return std::ranges::find(kOfDeviceReport, option.get_name()) != std::end(kOfDeviceReport) ||
           (group != kGroup && option.get_name() != "--output" &&
            std::ranges::find(kTakenGroups, group) != std::end(kTakenGroups));
}

}  // namespace

void addCalibrateOptions(CLI::App& command, CalibrateArguments& arguments) {
    const OptionGroup group(command, kGroup);
    addFlag(command, "--calibrate", arguments.enabled,
            "time the strategies on generated scenes instead of a SCENE: which one is fastest on this "
            "device, depending on the numbers of shaders and rays and on the cost of a hit");
    addCounts(command, "--calibrate-cases", arguments.caseWords, 1, synthetic::kMaxCases,
              "numbers of shaders, 1 to 256, separated by commas; auto: 1,4,16,64,256, or 1,16,64 with "
              "--quick (default: auto)");
    addCounts(command, "--calibrate-rays", arguments.rayWords, kMinRays, kMaxRays,
              "numbers of rays, 1024 to 64M (k: thousands, M: millions); auto: 1M,8M,32M, or 1M,8M with "
              "--quick; on a CPU 16k,64k,256k, or 16k,64k with --quick (default: auto)");
    addChoices(command, "--calibrate-cost", arguments.costs, {"cheap", "expensive"},
               "what shading a hit costs")
        .type_name("LIST");
    addChoices(command, "--calibrate-coherence", arguments.coherences, {"coherent", "incoherent"},
               "coherent: rays of a mirror; incoherent: rays of a white floor, which go anywhere")
        .type_name("LIST");
    addChoice(command, "--calibrate-shares", arguments.shares, {"uniform", "zipf"},
              "how hits are shared among shaders; zipf: in the proportions 1, 1/2, 1/3, …");
    addInteger(command, "--calibrate-lights", arguments.lights, 0, 64,
               "point lights that shade each hit; 0: only the sky");
    addFlag(command, "--calibrate-shadows", arguments.shadows,
            "hits send shadow rays to those lights; needs --calibrate-lights");
    addText(
        command, "--pictures", arguments.pictures, "DIR",
        "with --calibrate: write the smallest picture of each scene here, too; existing files are replaced");
    const OptionGroup report(command, "Device report");
    addOutputFile(
        command, kDeviceReport, arguments.deviceReport, "FILE.json", {".json"},
        "write what Glint's makers need to know of this device: times of the strategies on five generated "
        "scenes and on SCENE, if there is one, and statistics of all pipelines. It has no names of hosts, "
        "users or files (default: off)");
}

void checkCalibrateOptions(const CLI::App& command, const CalibrateArguments& arguments) {
    for (const CLI::Option* const option : command.get_options()) {
        if (option->count() == 0) {
            continue;
        }
        const std::string name = option->get_name();
        if (!arguments.deviceReport.empty()) {
            if (!isOfDeviceReport(*option)) {
                throw CLI::ValidationError(name,
                                           "can't be combined with --device-report; leave out one of them");
            }
            continue;
        }
        if (arguments.enabled && !isTaken(*option)) {
            throw CLI::ValidationError(
                name, option->get_positional()
                          ? "can't be combined with --calibrate, which makes its own scenes; leave it out"
                          : "can't be combined with --calibrate; leave out one of them");
        }
        if (!arguments.enabled && option->get_group() == kGroup) {
            throw CLI::ValidationError(name, "needs --calibrate; give both, or neither");
        }
    }
    if (!arguments.deviceReport.empty()) {
        return;
    }
    if (!arguments.enabled && command.get_option("SCENE")->count() == 0) {
        throw CLI::RequiredError("SCENE");
    }
    if (command.get_option("--output")->count() == 0) {
        throw CLI::RequiredError("--output");
    }
    if (arguments.shadows && arguments.lights == 0) {
        throw CLI::ValidationError("--calibrate-shadows", "needs lights; give --calibrate-lights 1 or more");
    }
}

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
    const OptionGroup group(command, "Sweep");
    addFlag(
        command, "--quick", arguments.quick,
        fmt::format("fewer values, pairs and rounds; a less certain reference, and {} unless --size is given",
                    kQuickSize));
    addChoice(command, "--depth", arguments.depth, {"singles", "pairs", "search"},
              "how far the sweep goes; singles: one setting at a time; pairs: then the pairs that matter; "
              "search: then a search for the Pareto front");
    std::vector<std::string> parts = compiler::settingNames();
    parts.emplace_back(kDenoise);
    addChoices(command, "--only", arguments.only, parts,
               "sweep only these settings, separated by commas (default: all); denoise: the picture filtered "
               "by examples/denoise, beside one of 64 samples")
        .type_name("LIST");
    addInteger(command, "--rounds", arguments.rounds, 0, 1000,
               fmt::format("pictures of each configuration, each with other random numbers; 0: {}, or {} "
                           "with --quick or --calibrate",
                           kRounds, kQuickRounds));
    addInteger(command, "--batch", arguments.batch, 1, 64,
               "configurations on the device at a time, besides the one with which all are compared");
    addTexts(command, "--candidate", arguments.candidateWords, "NAME=DIR",
             "measure this package of the scene, too; may be repeated")
        .allow_extra_args(false);
}

void addErrorOptions(CLI::App& command, BenchArguments& arguments) {
    const OptionGroup group(command, "Errors");
    addNamed(command, "--metric", arguments.metric,
             "the error by which configurations are ordered; trimmed: relMSE without the worst 0.1 % of "
             "pixels, so that fireflies do not decide");
    addChoice(
        command, "--reference", arguments.reference, {"full", "same"},
        "what errors are measured against; full: all of light transport, that is unlimited bounces, effects "
        "that send rays wherever light comes from, and so on; same: the effects and bounces of the default");
    addReal(command, "--reference-error", arguments.referenceError, 0.0, 1.0,
            fmt::format("relative error that the reference itself may have; 0: {}, or {} with --quick (0 to "
                        "1, default: 0)",
                        kReferenceError, kQuickReferenceError));
    addInteger(command, "--reference-spp", arguments.referenceSamples, 0, 1 << 24,
               fmt::format("the most samples per pixel of the reference; 0: {}, or {} with --quick",
                           kReferenceSamples, kQuickReferenceSamples));
    const OptionGroup advice(command, "Advice");
    addReal(command, "--budget-ms", arguments.budgetMs, 0.0, 1e9,
            "write the most exact settings within this time; to DIR/settings.json, by the time of a picture "
            "(0 to 1e9)");
    addReal(command, "--max-error", arguments.maxError, 0.0, 1e9,
            "write the fastest settings with at most this error; in the metric (0 to 1e9)");
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
            "folder of the results; index.html, bench.json, settings.json and images/, with --calibrate "
            "calibration.json; those of an earlier run are replaced, and any other content refused; required "
            "but for --device-report");
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
    CalibrateArguments& calibrate = arguments.calibrate;
    if (const auto cases = parseCounts(calibrate.caseWords, 1, synthetic::kMaxCases)) {
        calibrate.cases.assign(cases->begin(), cases->end());
    }
    if (const auto rays = parseCounts(calibrate.rayWords, kMinRays, kMaxRays)) {
        calibrate.rays = *rays;
    }
    arguments.candidates = base::mapped<measure::Candidate>(arguments.candidateWords, parseCandidate);
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

#include "cli/bench/calibrate_arguments.h"

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
constexpr std::string_view kTakenGroups[] = {kGroup, "Device", "Output", "Report"};
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
    addText(command, flags, value, "auto|LIST", help)
        .check(CLI::Validator(
            [min, max](const std::string& text) {
                return text == "auto" || parseCounts(text, min, max)
                           ? std::string()
                           : fmt::format("\"{}\" is neither auto nor a list of numbers from {} to {}", text,
                                         min, max);
            },
            ""))
        ->group(kGroup);
}

bool isTaken(const CLI::Option& option) {
    return std::ranges::find(kTakenGroups, option.get_group()) != std::end(kTakenGroups) ||
           std::ranges::find(kTaken, option.get_name()) != std::end(kTaken);
}

bool isOfDeviceReport(const CLI::Option& option) {
    const std::string group = option.get_group();
    return std::ranges::find(kOfDeviceReport, option.get_name()) != std::end(kOfDeviceReport) ||
           (group != kGroup && option.get_name() != "--output" &&
            std::ranges::find(kTakenGroups, group) != std::end(kTakenGroups));
}

}  // namespace

void addCalibrateOptions(CLI::App& command, CalibrateArguments& arguments) {
    addFlag(command, "--calibrate", arguments.enabled,
            "time the strategies on generated scenes instead of a\n"
            "SCENE: which one is fastest on this device, depending on\n"
            "the numbers of shaders and rays and on the cost of a hit")
        .group(kGroup);
    addCounts(command, "--calibrate-cases", arguments.caseWords, 1, synthetic::kMaxCases,
              "numbers of shaders, 1 to 256, separated by commas; auto:\n"
              "1,4,16,64,256, or 1,16,64 with --quick (default: auto)");
    addCounts(command, "--calibrate-rays", arguments.rayWords, kMinRays, kMaxRays,
              "numbers of rays, 1024 to 64M (k: thousands, M: millions);\n"
              "auto: 1M,8M,32M, or 1M,8M with --quick; on a CPU\n"
              "16k,64k,256k, or 16k,64k with --quick (default: auto)");
    addChoices(command, "--calibrate-cost", arguments.costs, {"cheap", "expensive"},
               "what shading a hit costs")
        .type_name("LIST")
        ->group(kGroup);
    addChoices(command, "--calibrate-coherence", arguments.coherences, {"coherent", "incoherent"},
               "coherent: rays of a mirror; incoherent: rays of a white\nfloor, which go anywhere")
        .type_name("LIST")
        ->group(kGroup);
    addChoice(command, "--calibrate-shares", arguments.shares, {"uniform", "zipf"},
              "how hits are shared among shaders; zipf: in the\n"
              "proportions 1, 1/2, 1/3, …")
        .group(kGroup);
    addInteger(command, "--calibrate-lights", arguments.lights, 0, 64,
               "point lights that shade each hit; 0: only the sky")
        .group(kGroup);
    addFlag(command, "--calibrate-shadows", arguments.shadows,
            "hits send shadow rays to those lights; needs\n--calibrate-lights")
        .group(kGroup);
    addText(command, "--pictures", arguments.pictures, "DIR",
            "with --calibrate: write the smallest picture of each\nscene here, too")
        .group(kGroup);
    addText(command, kDeviceReport, arguments.deviceReport, "FILE.json",
            "write what Glint's makers need to know of this device:\n"
            "times of the strategies on five generated scenes and on\n"
            "SCENE, if there is one, and statistics of all pipelines.\n"
            "It has no names of hosts, users or files (default: off)")
        .group("Device report");
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
            throw CLI::ValidationError(name,
                                       option->get_positional()
                                           ? "can't be combined with --calibrate, which makes its own scenes"
                                           : "can't be combined with --calibrate; leave out one of them");
        }
        if (!arguments.enabled && option->get_group() == kGroup) {
            throw CLI::ValidationError(name, "needs --calibrate");
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

std::vector<std::uint32_t> casesOf(const CalibrateArguments& arguments) {
    const auto given = parseCounts(arguments.caseWords, 1, synthetic::kMaxCases);
    return given ? std::vector<std::uint32_t>(given->begin(), given->end()) : std::vector<std::uint32_t>();
}

std::vector<std::uint64_t> raysOf(const CalibrateArguments& arguments) {
    return parseCounts(arguments.rayWords, kMinRays, kMaxRays).value_or(std::vector<std::uint64_t>());
}

}  // namespace glint::cli

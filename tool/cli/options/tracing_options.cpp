#include "cli/options/tracing_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace glint {
namespace {

constexpr const char* kAllOrList = "all|LIST";

template <typename Values>
std::vector<std::string> namesOf(const Values& values) {
    std::vector<std::string> names;
    for (const auto value : values) {
        names.emplace_back(package::nameOf(value));
    }
    return names;
}

std::vector<std::string> withAuto(std::vector<std::string> names) {
    names.emplace_back(measure::kAutoStrategy);
    return names;
}

std::vector<std::string> withAll(std::vector<std::string> names) {
    names.emplace_back("all");
    return names;
}

std::vector<std::string> orderingNames() {
    std::vector<std::string> names{"auto"};
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(package::Ordering::Count); ++i) {
        names.emplace_back(package::nameOf(static_cast<package::Ordering>(i)));
    }
    return names;
}

std::vector<CLI::Option*> addPlacement(CLI::App& command, measure::TracingSettings& arguments) {
    CLI::Option& shadows = addChoice(command, "--shadows", arguments.shadows, {"inline", "deferred"},
                                     "where shadow rays of hits are traced; inline: by the\n"
                                     "shader that shades the hit; deferred: by a pass of\ntheir own");
    CLI::Option& record = addChoice(
        command, "--hit-record", arguments.hitRecord, {"full", "packed"},
        "what is kept of a hit between passes (visibility,\nsorted-uber); full: 32 bytes; packed: 16");
    CLI::Option& fetch = addFlag(command, "--position-fetch", arguments.positionFetch,
                                 "uber (with ray queries) and hit-shaders read positions\n"
                                 "from the acceleration structure instead of from vertices");
    shadows.group("Shaders");
    record.group("Shaders");
    fetch.group("Shaders");
    return {&shadows, &record, &fetch};
}

}  // namespace

void addTracingLists(CLI::App& command, measure::TracingSettings& arguments) {
    arguments.strategies = {"uber", "visibility"};
    arguments.tracers = {"ray-query"};
    addChoices(command, "--strategy", arguments.strategies, withAuto(withAll(namesOf(package::kStrategies))),
               "how hits can be shaded, separated by commas; uber: one\n"
               "shader traces and shades; visibility: hits are sorted by\n"
               "shader first, then one dispatch for each shader;\n"
               "sorted-uber: hits are sorted, then one dispatch;\n"
               "hit-shaders: a ray tracing pipeline; auto: the one that\n"
               "should be fastest at 1920x1080, by --calibration")
        .type_name("auto|all|LIST")
        ->group("Shaders");
    addChoices(command, "--tracer", arguments.tracers, withAll(namesOf(package::kTracers)),
               "what traces rays, separated by commas; ray-pipeline: for\n"
               "devices without ray queries; hit-shaders always has its\nown")
        .type_name(kAllOrList)
        ->group("Shaders");
    addPlacement(command, arguments);
}

void addCalibration(CLI::App& command, std::string& file) {
    addText(command, "--calibration", file, "FILE.json",
            "device.json of `glint bench --calibrate`: what strategies\n"
            "cost on a device (default: constants that are built in)")
        .group("Shaders");
}

void checkTracingChoice(const measure::TracingSettings& arguments) {
    const bool pipelineOnly =
        measure::strategyNamed(arguments.strategies.front()) == package::kStrategyHitShaders;
    if (pipelineOnly && measure::tracerNamed(arguments.tracers.front()) == package::kTracerRayQuery) {
        throw CLI::ValidationError(
            "--tracer",
            "ray-query can't run --strategy hit-shaders, which is a ray tracing pipeline: "
            "leave out --tracer, or use --strategy uber");
    }
}

std::vector<CLI::Option*> addTracingChoice(CLI::App& command, measure::TracingSettings& arguments) {
    arguments.strategies = {"visibility"};
    arguments.tracers = {"auto"};
    std::vector<std::string> tracers = namesOf(package::kTracers);
    tracers.insert(tracers.begin(), "auto");
    addChoice(command, "--strategy", arguments.strategies.front(), withAuto(namesOf(package::kStrategies)),
              "how hits are shaded; uber: one shader traces and shades;\n"
              "visibility: hits are sorted by shader first, then one\n"
              "dispatch for each shader; sorted-uber: hits are sorted,\n"
              "then one dispatch; hit-shaders: a ray tracing pipeline;\n"
              "auto: the one that should be fastest, by --calibration")
        .group("Shaders");
    addChoice(command, "--tracer", arguments.tracers.front(), tracers,
              "what traces rays; auto: ray-query where the device has\n"
              "it, else ray-pipeline; hit-shaders always uses\n"
              "ray-pipeline")
        .group("Shaders");
    return addPlacement(command, arguments);
}

void addFrameOptions(CLI::App& command, measure::FrameSettings& arguments) {
    const std::string group = "Reflections";
    addReal(command, "--mirror-roughness", arguments.mirrorRoughness, 0.0, 1.0,
            "smoother surfaces reflect as mirrors\n(0 to 1, default: 0.05)")
        .group(group);
    addText(command, "--ssr", arguments.ssr, "off|N",
            "march N steps in screen space before a ray is sent\n(1 to 1024, default: off)")
        .check(CLI::Validator(
            [](const std::string& text) {
                return measure::screenStepsOf(text) >= 0
                           ? std::string()
                           : "\"" + text + "\" is neither off nor a number from 1 to 1024";
            },
            ""))
        ->group(group);
    addReal(command, "--ssr-thickness", arguments.ssrThickness, 0.0, 1.0,
            "how far a surface reaches behind its depth in that march,\n"
            "as a share of its distance (0 to 1, default: 0.02)")
        .group(group);
    addReal(command, "--clamp", arguments.clamp, 0.0, 1e9,
            "the most luminance that a ray adds to a sample: less\n"
            "noise, some light lost (0 to 1e9, default: 0, no limit)")
        .group(group);
    addChoice(command, "--binning", arguments.binning, {"none", "sign", "octahedral"},
              "sort the rays of a workgroup by direction")
        .group(group);
    addChoice(
        command, "--ordering", arguments.ordering, orderingNames(),
        "how visibility and sorted-uber sort hits by shader;\nauto: by the device and the number of shaders; "
        "else\nglobal-atomics, wave-loop, wave-aggregated,\nwave-ballot, local-histogram or tile-sort")
        .type_name("auto|NAME")
        ->group(group);
}

}  // namespace glint

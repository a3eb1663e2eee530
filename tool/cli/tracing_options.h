// Options of how rays are traced and shaded: what a package is compiled for, and what a renderer chooses at
// run time.
#pragma once

#include "cli/options.h"

#include <glint/renderer.h>

#include <optional>
#include <string>
#include <vector>

namespace glint {

// The value of --strategy that a cost model replaces by one of the others (cli/strategy_advice.h).
inline constexpr const char* kAutoStrategy = "auto";

// What a package can do. Strategies and tracers are lists for `compile`, and one value each for `render`.
struct TracingArguments {
    std::vector<std::string> strategies;
    std::vector<std::string> tracers;
    std::string shadows = "inline";
    std::string hitRecord = "full";
    bool positionFetch = false;
    std::optional<StrategyAdvice> advice{};  // where a strategy was auto, which has been resolved
    // `available`: Tracer bits among which "auto" chooses, ray queries first.
    void apply(CompileSettings& settings, std::uint32_t available = package::kTracerRayQuery) const;
};
// --strategy and --tracer of lists, --shadows, --hit-record, --position-fetch.
void addTracingLists(CLI::App& command, TracingArguments& arguments);
// --strategy and --tracer of one value, --shadows, --hit-record, --position-fetch. Returns what a package
// decides: all but the first.
std::vector<CLI::Option*> addTracingChoice(CLI::App& command, TracingArguments& arguments);

// --calibration: the device file that --strategy auto chooses by; `file` is empty without.
void addCalibration(CLI::App& command, std::string& file);

// Throws a CLI::ParseError where the tracer can't run the strategy.
void checkTracingChoice(const TracingArguments& arguments);

// What a renderer chooses.
struct FrameArguments {
    std::string ordering = "auto";
    std::string binning = "none";
    std::string ssr = "off";  // or a number of steps
    double ssrThickness = 0.02;
    double mirrorRoughness = 0.05;
    double clamp = 0.0;  // 0: no limit
    void apply(RendererOptions& options) const;
    void apply(FrameOptions& frame) const;
};
void addFrameOptions(CLI::App& command, FrameArguments& arguments);

// Of one name that --strategy or --tracer takes.
package::Strategy strategyNamed(const std::string& name);
package::Tracer tracerNamed(const std::string& name);

}  // namespace glint

// Options that decide how rays are traced and shaded: those that a package is compiled with, and those that a
// renderer chooses at run time.
#pragma once

#include "cli/options.h"

#include <glint/renderer.h>

#include <optional>
#include <string>
#include <vector>

namespace glint {

// The value of --strategy that a cost model replaces by a real strategy (cli/strategy_advice.h).
inline constexpr const char* kAutoStrategy = "auto";

// The capabilities of a package. Strategies and tracers are lists for `compile`, and one value each for
// `render`.
struct TracingArguments {
    std::vector<std::string> strategies;
    std::vector<std::string> tracers;
    std::string shadows = "inline";
    std::string hitRecord = "full";
    bool positionFetch = false;
    std::optional<StrategyAdvice> advice{};  // where a strategy was auto, which has been resolved
    // `available` has the Tracer bits among which "auto" chooses, ray queries first.
    void apply(CompileSettings& settings, std::uint32_t available = package::kTracerRayQuery) const;
};
// Adds --strategy and --tracer as lists, --shadows, --hit-record, --position-fetch.
void addTracingLists(CLI::App& command, TracingArguments& arguments);
// Adds --strategy and --tracer with one value, --shadows, --hit-record, --position-fetch. Returns the options
// that a package decides: all but the first.
std::vector<CLI::Option*> addTracingChoice(CLI::App& command, TracingArguments& arguments);

// Adds --calibration: the device file by which --strategy auto chooses. `file` is empty if it is not given.
void addCalibration(CLI::App& command, std::string& file);

// Throws a CLI::ParseError if the tracer can't run the strategy.
void checkTracingChoice(const TracingArguments& arguments);

// The settings that a renderer chooses.
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

// These convert a name that --strategy or --tracer takes.
package::Strategy strategyNamed(const std::string& name);
package::Tracer tracerNamed(const std::string& name);

}  // namespace glint

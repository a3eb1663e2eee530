// A configuration of a bench, and its measurements.
#pragma once

#include "image/compare.h"

#include <glint/measure/settings.h>
#include <glint/measure/statistics.h>
#include <glint/renderer.h>
#include <glint/result.h>

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::measure {

// Milliseconds from the list of rays to their shaded hits.
struct HitTimes {
    double dispatch = 0.0;  // makes the indirect arguments of the list of rays
    double trace = 0.0;   // traces rays and writes hit records, in strategies with a pass of its own for that
    double order = 0.0;   // sorts those records by bucket
    double shade = 0.0;   // shades hits; strategies that order none also trace here
    double shadow = 0.0;  // traces deferred shadow rays, and dispatches them

    double sum() const {
        return dispatch + trace + order + shade + shadow;
    }
    HitTimes& operator+=(const HitTimes& other);
    HitTimes& operator/=(double count);
};

// Adds up all passes of a sample (Timing::Passes).
HitTimes hitTimesOf(std::span<const PassTiming> passes);

using glint::nameOf;

// The error by which points are ordered, a member of ImageErrors.
enum class ErrorMetric : std::uint8_t { RelMse, Trimmed, Rmse, Flip };
inline constexpr Named<ErrorMetric> kErrorMetricNames[] = {{ErrorMetric::RelMse, "relMse"},
                                                           {ErrorMetric::Trimmed, "trimmed"},
                                                           {ErrorMetric::Rmse, "rmse"},
                                                           {ErrorMetric::Flip, "flip"}};
constexpr std::span<const Named<ErrorMetric>> namesOf(ErrorMetric /*type*/) {
    return kErrorMetricNames;
}
double valueOf(ErrorMetric metric, const image::ImageErrors& errors);
// Returns the error in a measure that adds up over independent causes: that of RMSE is its square.
double additive(ErrorMetric metric, double error);

enum class PointKind : std::uint8_t { Default, Single, Pair, Search, Package, Exact, Filtered };
inline constexpr Named<PointKind> kPointKindNames[] = {
    {PointKind::Default, "default"},  {PointKind::Single, "single"},   {PointKind::Pair, "pair"},
    {PointKind::Search, "search"},    {PointKind::Package, "package"}, {PointKind::Exact, "exact"},
    {PointKind::Filtered, "filtered"}};
constexpr std::span<const Named<PointKind>> namesOf(PointKind /*type*/) {
    return kPointKindNames;
}
// Returns whether settings alone distinguish such a point from the default.
constexpr bool isOfSettings(PointKind kind) {
    return kind != PointKind::Package && kind != PointKind::Filtered;
}

// The name under which the passes of all cases count together: "shade <case>".
inline constexpr std::string_view kShadeCases = "shade cases";
// The name of the time of a filter.
inline constexpr std::string_view kFilterPass = "denoise";

// Each list has one entry for each round, in the order of rounds. Times are milliseconds of the device.
struct BenchPoint {
    PointKind kind = PointKind::Single;
    compiler::Configuration configuration;  // the settings that differ from the default
    std::string name;                       // for people
    std::string package;                    // folder of one that was given; empty: compiled
    std::uint32_t filteredFrames = 0;       // pictures that a filter has seen, with the last; 0: no filter
    std::vector<double> times;              // of a picture
    std::vector<double> ratios;             // to the default in the same round
    std::map<std::string, std::vector<double>> passes;
    std::vector<double> hitMs;      // the times in which strategies differ
    std::vector<HitTimes> hits;     // its passes
    std::vector<double> hitRatios;  // of hitMs to that of the default in the same round
    std::vector<image::ImageErrors> errors;
    std::vector<double> errorRatios;  // to the default with the same seed, in the chosen metric
    // The errors of the mean of all rounds' pictures.
    std::optional<image::ImageErrors> errorOfMean;
    bool sameImage = true;        // as the default's, bit-exact, in every round
    LinearImage image;            // of the first round
    Renderer::Counters counters;  // of its last sample
    Renderer::Footprint footprint;
    std::uint32_t cases = 0;
    std::string tracer;
    std::string ordering;  // empty where hits are not ordered
};

// Times relative to the default's median, so that drifts of the machine between batches do not matter.
Interval timeRatio(const BenchPoint& point);
Interval errorOf(const BenchPoint& point, ErrorMetric metric);
// Returns whether the interval of the ratio contains 1.
bool isTimeTie(const BenchPoint& point);
bool isErrorTie(const BenchPoint& point);

}  // namespace glint::measure

// A configuration of a bench and what was measured of it.
#pragma once

#include "bench/hit_times.h"
#include "bench/settings.h"
#include "bench/statistics.h"
#include "image/error.h"

#include <glint/renderer.h>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// The error that points are ordered by, a member of ImageErrors.
enum class ErrorMetric { RelMse, Trimmed, Rmse, Flip };
std::string_view nameOf(ErrorMetric metric);  // as the JSON has it: "relMse"
ErrorMetric metricNamed(std::string_view name);
double valueOf(ErrorMetric metric, const ImageErrors& errors);

enum class PointKind { Default, Single, Pair, Search, Package };
std::string_view nameOf(PointKind kind);

// The name under which passes of all cases count: "shade <case>".
inline constexpr std::string_view kShadeCases = "shade cases";

// One entry a round in each list, in order of the rounds; times are milliseconds of the device.
struct BenchPoint {
    PointKind kind = PointKind::Single;
    bench::Configuration configuration;  // what differs from the default
    std::string name;                    // for people
    std::string package;                 // folder of one that was given; empty: compiled
    std::vector<double> times;           // of a picture
    std::vector<double> ratios;          // to the default in the same round
    std::map<std::string, std::vector<double>> passes;
    std::vector<double> hitMs;          // what strategies differ in
    std::vector<bench::HitTimes> hits;  // its passes
    std::vector<double> hitRatios;      // of hitMs to that of the default in the same round
    std::vector<ImageErrors> errors;
    std::vector<double> errorRatios;  // to the default with the same seed, in the chosen metric
    bool sameImage = true;            // as the default's, bit by bit, in every round
    LinearImage image;                // of the first round
    FrameCounters counters;           // of its last sample
    Renderer::Footprint footprint;
    std::uint32_t cases = 0;
    std::string tracer;
    std::string ordering;  // empty where hits are not ordered
};

// In units of the default's median: free of drifts of the machine between batches.
bench::Interval timeRatio(const BenchPoint& point);
bench::Interval errorOf(const BenchPoint& point, ErrorMetric metric);
// The interval of the ratio has 1.
bool isTimeTie(const BenchPoint& point);
bool isErrorTie(const BenchPoint& point);

}  // namespace glint

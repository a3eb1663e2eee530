// The results of glint bench, as JSON and as text.
#pragma once

#include "bench/settings.h"
#include "cli/bench_machine.h"
#include "cli/bench_point.h"
#include "cli/bench_reference.h"
#include "cli/bench_strategies.h"
#include "cli/report.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glint {

struct BenchScene {
    std::string file;
    std::uint64_t triangles = 0;
    std::uint32_t instances = 0;
    std::size_t materials = 0;
    std::uint32_t lights = 0;
    std::string camera;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::string environment;  // empty: none
};

struct BenchAdvice {
    std::optional<double> budgetMs;
    std::optional<double> maxError;
    std::optional<std::size_t> point;  // nothing: none is within it
    std::string file;                  // of settings
    std::string why;
};

struct BenchReport {
    std::string command;
    std::string date;                    // UTC, ISO 8601
    std::vector<std::string> viewWords;  // of the command line that are no settings
    BenchScene scene;
    BenchMachine machine;
    std::uint32_t rounds = 0;
    std::uint32_t seed = 0;
    std::uint32_t batch = 0;
    bool quick = false;
    double seconds = 0.0;
    ErrorMetric metric = ErrorMetric::RelMse;
    Reference reference;
    bench::Configuration base;
    std::vector<bench::Setting> settings;
    std::vector<BenchPoint> points;  // the default first
    std::vector<std::size_t> front;  // indices of points, from the fastest
    StrategyReport strategies;
    std::optional<BenchAdvice> advice;
};

// Returns milliseconds of a picture: the point's ratio times the default's median.
bench::Interval timeOf(const BenchReport& report, std::size_t point);

// Returns a picture's file relative to the output folder: "images/007.png".
std::string imageName(std::size_t point);
std::string errorImageName(std::size_t point);
inline constexpr const char* kReferenceImage = "images/reference.png";

// Returns the factor by which the page's pictures are smaller in width and height, so that the page can still
// be sent. The pictures in the folder have full size.
std::uint32_t pictureScale(const BenchReport& report);

// Returns a command line that renders a point: "glint render scene.gltf -o picture.png --spp 4".
std::string renderCommand(const BenchReport& report, const BenchPoint& point);

Json toJson(const BenchReport& report);
std::string toText(const BenchReport& report);

}  // namespace glint

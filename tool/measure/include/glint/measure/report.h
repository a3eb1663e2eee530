// The results of a bench, and the files that show them.
#pragma once

#include "base/fields_fwd.h"
#include "gltf/import.h"

#include <glint/measure/machine.h>
#include <glint/measure/point.h>
#include <glint/measure/settings.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint::measure {

// The picture against which a bench measures errors: it has no approximation, and as many samples as its
// accuracy needs.
struct Reference {
    LinearImage image;
    bool isFull = true;                     // has all of light transport
    compiler::Configuration configuration;  // over the base
    std::uint32_t samples = 0;              // a pixel
    double exposure = 0.0;                  // stops: automatic, for every measure and picture of the bench
    image::ImageErrors noise;               // of the reference itself
    // The root of noise.trimmed. A light that few rays find leaves outliers after any number of samples, and
    // these would otherwise dominate the error.
    double relativeError = 0.0;
    double target = 0.0;   // the requested error
    bool reached = false;  // the target
    bool cached = false;   // samples were taken from the cache, all or some
    double seconds = 0.0;  // wall clock
};

// Times in milliseconds for a picture; they are medians.
struct StrategyRow {
    std::string strategy;
    std::size_t point = 0;  // index
    Interval ratio;         // of time, to the default
    // The time of the passes in which strategies differ, from the list of rays to their shaded hits.
    Interval hits;
    Interval hitRatio;     // of those, to the default's in the same round
    double traceMs = 0.0;  // of hits that are traced by a pass of their own
    double orderMs = 0.0;
    double shadeMs = 0.0;    // the rest of `hits`; with tracing where a strategy shades while it traces
    double commonMs = 0.0;   // the passes that all strategies share
    std::uint32_t rays = 0;  // of the last sample
};

struct StrategyReport {
    std::vector<StrategyRow> rows;     // those that were measured, of the default's other settings
    std::vector<std::string> fastest;  // several: a tie
    // Counts of hits in the last sample of a strategy that counts them by case; the members are 0 if no such
    // strategy was measured.
    std::uint32_t cases = 0;
    std::uint32_t filledCases = 0;  // cases with hits
    double largestShare = 0.0;      // of hits in the case that has most
    // The average number of cases among 32 hits in random order. An uber shader runs at most that many one
    // after another in a subgroup of that size.
    double casesInWave = 0.0;
    std::vector<std::string> why;  // sentences
};

// `base` is the strategy of the default, which is the first of `points`.
StrategyReport compareStrategies(std::span<const BenchPoint> points, const std::string& base);

// The part of the default's error that a configuration removes, as shares of that error in an additive
// measure (additive()). Below 0 the error grows.
struct RemovedError {
    std::size_t point = 0;  // index of the configuration
    Interval all;           // from rounds with the same seed
    double bias = 0.0;      // the part that no number of samples removes
    double noise = 0.0;     // the part that more samples also remove
};

// An approximation of the default, and the part of the error that its exact value alone removes.
struct ErrorPart {
    std::string setting;
    std::string from;  // the default's value
    std::string to;    // the reference's
    RemovedError removed;
};

// The default's error, divided among its approximations.
struct ErrorParts {
    std::vector<ErrorPart> parts;       // the most bias first
    std::optional<RemovedError> exact;  // all these values at once; absent if none was measured
    double noise = 0.0;                 // share of the error; 0 if there was one round
    // The share of bias that is in no part. Above 0, only several exact values together remove it; below 0,
    // the parts overlap.
    double rest = 0.0;
};

// `points` has the default first. A setting is left out if no point has its exact value alone.
ErrorParts partsOfError(std::span<const BenchPoint> points, std::span<const Setting> settings,
                        ErrorMetric metric);

struct BenchScene {
    std::string file;
    gltf::SceneInFile inFile{};
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
    compiler::Configuration base;
    std::vector<Setting> settings;
    std::vector<BenchPoint> points;  // the default first
    std::vector<std::size_t> front;  // indices of points, from the fastest
    StrategyReport strategies;
    ErrorParts errorParts;
    std::optional<BenchAdvice> advice;
};
base::Fields fieldsOf(const BenchReport*);

// Returns the description of the reference: "all of light transport (--bounces unlimited ...)".
std::string describeReference(const BenchReport& report);

// Returns milliseconds of a picture: the point's ratio times the default's median.
Interval timeOf(const BenchReport& report, std::size_t point);

// Returns a picture's file relative to the output folder: "images/007.png".
std::string imageName(std::size_t point);
std::string errorImageName(std::size_t point);
inline constexpr const char* kReferenceImage = "images/reference.png";

// Returns the factor by which the page's pictures are smaller in width and height, so that the page can still
// be sent. The pictures in the folder have full size.
std::uint32_t pictureScale(const BenchReport& report);

// Returns a command line that renders a point: "glint render scene.gltf -o picture.png --spp 4".
std::string renderCommand(const BenchReport& report, const BenchPoint& point);

inline constexpr const char* kPageFile = "index.html";
inline constexpr const char* kReportFile = "bench.json";
inline constexpr const char* kSettingsFile = "settings.json";

// Returns the error "bench-folder" unless `folder` belongs to an earlier bench (it has the file `mark`), is
// empty, or could be created. Writes nothing yet.
Status checkBenchFolder(const std::filesystem::path& folder, const char* mark = kReportFile);

// Makes a folder and its parents. Error "bench-folder".
Status makeBenchFolder(const std::filesystem::path& folder, const std::string& hint = "give another -o");

// Writes pictures first, then settings, report and page, each replaced as a whole. Pictures of an earlier
// bench that this one lacks are removed. Errors "file-write", "png-encode".
Status writeBench(const BenchReport& report, const std::filesystem::path& folder);

}  // namespace glint::measure

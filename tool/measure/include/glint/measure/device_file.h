// A calibration: its settings, the times that it measured, the costs that are fitted to them, and the file of
// these.
#pragma once

#include "base/fields_fwd.h"
#include "plan/strategy_cost.h"
#include "settings/settings.h"

#include <glint/measure/machine.h>
#include <glint/measure/point.h>
#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace glint::measure {

// A case of the scene: its share of all hits (1 over all cases), and the size of its shader's code.
struct CaseWork {
    double share = 0.0;
    double instructions = 0.0;  // SPIR-V instructions in the module with which `visibility` shades the case
    double fetches = 0.0;       // texture fetches in the same module
};

// The device's time in milliseconds for one sample, from the list of rays to their shaded hits. It is the
// median of the first strategy, times the median of this strategy's ratio to it in the same round. A clock
// that changes between rounds does not affect that ratio.
struct StrategyTime {
    std::string strategy;  // as in --strategy
    double ms = 0.0;
};

struct CalibrationPoint {
    std::uint32_t cases = 0;
    std::string cost;            // "cheap" or "expensive"
    std::string coherence;       // "coherent" or "incoherent"
    double rays = 0.0;           // in the list, for one sample
    double hitShare = 0.0;       // share of rays that hit something
    double coherentShare = 0.0;  // share of hits whose neighbours are alike: see coherentShareOf()
    std::vector<CaseWork> work;  // by shader ID
    std::vector<StrategyTime> times;
};

// The difference between estimates and measurements to which the constants were not fitted (see
// FitQuality::held).
struct StrategyQuality {
    std::string strategy;
    std::size_t points = 0;
    double medianError = 0.0;  // |estimate / measured - 1|
    double worstError = 0.0;
    std::string worstPoint;  // "64 cases, expensive, incoherent, 1000000 rays"
};

// The cost of choosing by the model: the time of the strategy that it takes over the time of the fastest,
// minus 1. It covers the points at which two or more strategies were measured.
struct Regret {
    std::size_t points = 0;
    double median = 0.0;
    double worst = 0.0;
    double withinFivePercent = 0.0;  // share of the points with a regret of at most 5 %
    std::string worstPoint;          // names the strategy taken and the fastest one
};

struct FitQuality {
    // Each group of points that differ only in their rays was estimated by constants fitted to all other
    // groups. With a single group, all estimates come from the one fit.
    bool held = false;
    std::vector<StrategyQuality> strategies;
    Regret regret;
};

struct DeviceFit {
    std::vector<compiler::StrategyCosts> strategies;  // in the order of simplestFirst()
    FitQuality quality;
    std::vector<std::string> omitted;  // sentences that say which strategy has no constants, or which point
                                       // was not usable
};

// Fits each strategy separately, with all constants at least 0, by least squares of relative errors. Points
// that are not usable (times, rays or shares that are not numbers or are out of range) are left out and
// reported. A strategy needs as many points as it has terms, and at least two; otherwise it has no constants.
DeviceFit fitStrategies(std::span<const CalibrationPoint> points, double subgroupSize);

// Returns the point in the form that the model takes.
compiler::Round roundOf(const CalibrationPoint& point);

// --- Calibrations ---

// The difference between a picture and that of uber. The strategy must not change the picture.
struct PictureDifference {
    double largest = 0.0;         // |a - b| / max(1, |b|) over all channels
    std::uint64_t differing = 0;  // pixels that differ by more than 0.001 of that
    std::uint64_t pixels = 0;     // all
    bool isWrong() const;         // more than 1 in 1000
};

// A strategy at one point, with its times for one sample.
struct StrategyMeasure {
    std::string strategy;
    std::string skipped;  // why it did not run; empty: it did
    std::string tracer;
    std::string ordering;        // empty where hits are not ordered
    std::vector<double> times;   // milliseconds of the passes that strategies differ in, one a round
    std::vector<double> ratios;  // to uber in the same round
    HitTimes split;              // means over all rounds
    double pipelineMs = 0.0;     // wall clock
    double firstMs = 0.0;        // wall clock of the first sample, in which drivers may compile
    std::uint64_t bytes = 0;     // of buffers and images
    PictureDifference difference;
};

struct CalibrationEntry {
    CalibrationPoint point;  // its times: of the strategies that ran, whose pictures are right
    std::string shares;
    std::uint32_t lights = 0;
    bool shadows = false;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t samples = 0;  // samples of which each time is the mean
    std::uint64_t hits = 0;     // a sample
    std::uint32_t filledCases = 0;
    std::vector<StrategyMeasure> strategies;
    // The strategies whose interval of the ratio overlaps with that of the fastest; empty if nothing ran.
    std::vector<std::string> fastest;
};
base::Fields fieldsOf(const CalibrationEntry*);

struct CalibrationReport {
    std::string command;
    std::string date;  // UTC, ISO 8601
    BenchMachine machine;
    std::uint32_t rounds = 0;
    std::uint32_t seed = 0;
    bool quick = false;
    double compileSeconds = 0.0;  // wall clock, before anything is measured
    double seconds = 0.0;         // wall clock of everything
    bool complete = false;        // else more points were to come
    std::vector<CalibrationEntry> entries;
};
// Reads what is needed to fit costs to it. Values that follow from others, and those of the run, are not
// read.
base::Fields fieldsOf(const CalibrationReport*);

// Returns the mean over the cases, weighted by their shares of hits, that is, the work of an average hit.
double meanOf(const std::vector<CaseWork>& work, double CaseWork::*member);

// Fills in the members that follow from the measurements: point.times and fastest.
void settleEntry(CalibrationEntry& entry);

struct CalibrationSettings {
    compiler::Settings render;
    std::string output;                // folder of calibration.json
    bool quick = false;                // fewer numbers of cases and of rays
    std::vector<std::uint32_t> cases;  // empty: by `quick`
    std::vector<std::uint64_t> rays;   // empty: by `quick` and the device
    std::vector<std::string> costs{"cheap", "expensive"};
    std::vector<std::string> coherences{"coherent", "incoherent"};
    std::string shares = "uniform";  // or "zipf"
    std::int64_t lights = 0;         // point lights, besides the sky
    bool shadows = false;            // of those lights
    std::string pictures;            // folder; empty: none are written
};

// --- device.json ---

struct DeviceFile {
    compiler::DeviceCosts costs;
    FitQuality quality;
};
base::Fields fieldsOf(const DeviceFile*);

// Fits the constants of a device to measurements on it. `device` holds everything except its strategies. Adds
// notes "calibration-points" about points that were left out. Returns an error with that id if no strategy
// could be fitted.
Result<DeviceFile> fitDevice(compiler::DeviceCosts device, std::span<const CalibrationPoint> points,
                             std::vector<Diagnostic>& notes);

// Returns JSON in the format of docs/schemas/device.json.
std::string toText(const DeviceFile& file);

// Errors "file-open", "file-read", "calibration-format".
Result<DeviceFile> readDeviceFile(const std::filesystem::path& path);

struct CalibrationPoints {
    compiler::DeviceCosts device;  // without strategies
    std::vector<CalibrationPoint> points;
};

// Reads the format of docs/schemas/calibration.json, without strategies that were skipped or drew another
// picture. `machine` may have a `subgroupSize`; its default is 8 for a CPU and 32 for a GPU. Errors
// "file-open", "file-read", "calibration-format".
Result<CalibrationPoints> readCalibrationPoints(const std::filesystem::path& path);

}  // namespace glint::measure

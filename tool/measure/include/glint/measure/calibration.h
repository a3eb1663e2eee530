// Measures on generated scenes which strategy is fastest on a device: `glint bench --calibrate` without a
// command line.
#pragma once

#include <glint/context.h>
#include <glint/measure/device_file.h>
#include <glint/measure/hit_times.h>
#include <glint/measure/machine.h>
#include <glint/measure/observer.h>
#include <glint/measure/render_settings.h>
#include <glint/measure/strategy_fit.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glint::compiler {
class ModuleCache;
}  // namespace glint::compiler

namespace glint::measure {

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

inline constexpr const char* kCalibrationFile = "calibration.json";
inline constexpr const char* kDeviceFile = "device.json";

// Opens the device that `render` names, without a window. Has the errors of Context::createHeadless().
Result<std::unique_ptr<Context>> openCalibrationDevice(const compiler::Settings& render);

// Compiles all scenes, and then measures them one after another. Writes calibration.json after each group of
// scenes, so that an interrupted run keeps its measurements. The caller has set command, date, machine,
// rounds, seed and quick of `report`. `cache` may be null. Warns "calibrate-point" of strategies that did not
// run and "calibrate-picture" of pictures that are wrong. Errors: of the device, of compiling,
// "bench-folder", "file-write", "validation".
Status runCalibration(const Observer& observer, const CalibrationSettings& settings, Context& context,
                      compiler::ModuleCache* cache, CalibrationReport& report);

// Fits the constants of the device to the calibration.json in `folder`, as scripts do with other
// measurements, and writes device.json beside it. Too few measurements are a note, and the result is empty.
// Errors of readFile() and writeFile(), "calibration-format".
Result<std::optional<DeviceFile>> fitCalibration(const Observer& observer,
                                                 const std::filesystem::path& folder);

}  // namespace glint::measure

// The results of glint bench --calibrate, as JSON and as text.
#pragma once

#include "bench/calibration_point.h"
#include "bench/hit_times.h"
#include "cli/bench_machine.h"
#include "synthetic/cases_scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace glint {

// How far a picture is from that of uber. The way in which hits are shaded must not change it.
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
    bench::HitTimes split;       // means over all rounds
    double pipelineMs = 0.0;     // wall clock
    double firstMs = 0.0;        // wall clock of the first sample, in which drivers may compile
    std::uint64_t bytes = 0;     // of buffers and images
    PictureDifference difference;
};

struct CalibrationEntry {
    bench::CalibrationPoint point;  // its times: of the strategies that ran, whose pictures are right
    std::string shares;
    std::uint32_t lights = 0;
    bool shadows = false;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t samples = 0;  // that each time is the mean of
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
    double seconds = 0.0;         // likewise, of everything
    bool complete = false;        // else more points were to come
    std::vector<CalibrationEntry> entries;
};

// Fills in what follows from the measurements: point.times and fastest.
void settleEntry(CalibrationEntry& entry);

Json toJson(const CalibrationReport& report);
// Returns a table in Markdown.
std::string toText(const CalibrationReport& report);

}  // namespace glint

// The parts of glint bench: its command line, a filter that it measures, and its text.
#pragma once

#include "cli/cache.h"
#include "cli/render/arguments.h"
#include "synthetic/cases_scene.h"

#include <glint/measure/bed.h>
#include <glint/measure/bench.h>
#include <glint/measure/calibration.h>
#include <glint/measure/device_file.h>
#include <glint/measure/report.h>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace glint::cli {

struct CalibrateArguments {
    bool enabled = false;
    // The words as given. "auto" depends on the device and --quick.
    std::string caseWords = "auto";
    std::string rayWords = "auto";
    std::vector<std::string> costs{"cheap", "expensive"};
    std::vector<std::string> coherences{"coherent", "incoherent"};
    std::string shares = "uniform";
    std::int64_t lights = 0;
    bool shadows = false;
    std::string pictures;      // folder; empty: none are written
    std::string deviceReport;  // file; empty: none is made
};

void addCalibrateOptions(CLI::App& command, CalibrateArguments& arguments);
// Throws a CLI::ParseError if options contradict each other.
void checkCalibrateOptions(const CLI::App& command, const CalibrateArguments& arguments);

// Parses "1,4,16"; empty for "auto". The text must have passed the checks of addCalibrateOptions().
std::vector<std::uint32_t> casesOf(const CalibrateArguments& arguments);
// Parses "16k,1M" in the same way; k is a thousand, M a million.
std::vector<std::uint64_t> raysOf(const CalibrateArguments& arguments);

// --- The command line of glint bench ---

struct BenchArguments : measure::BenchSettings {
    RenderArguments render;  // the default that everything is compared with
    std::vector<std::string> candidateWords;
    CalibrateArguments calibrate;

    std::string command;                 // to repeat it
    std::vector<std::string> viewWords;  // those that are no settings
};

void addBenchOptions(CLI::App& command, BenchArguments& arguments);
// Fills in the members that follow from the parsed `command`. Throws a CLI::ParseError if options contradict
// each other.
void settleBench(const CLI::App& command, BenchArguments& arguments);

// Null in a build without the examples.
const measure::FilterMaker* exampleFilter();

// --- Results for people ---

std::string toText(const measure::BenchReport& report);
// Returns a table in Markdown.
std::string toText(const measure::CalibrationReport& report);
// Describes the constants, how far estimates are off, and the cost of choosing by them.
std::string describe(const measure::DeviceFile& file);

}  // namespace glint::cli

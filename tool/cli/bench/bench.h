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

#include <string>
#include <vector>

namespace glint::cli {

struct CalibrateArguments : measure::CalibrationSettings {
    bool enabled = false;
    // The words as given. "auto" depends on the device and --quick.
    std::string caseWords = "auto";
    std::string rayWords = "auto";
    std::string deviceReport;  // file; empty: none is made
};

void addCalibrateOptions(CLI::App& command, CalibrateArguments& arguments);
// Throws a CLI::ParseError if options contradict each other.
void checkCalibrateOptions(const CLI::App& command, const CalibrateArguments& arguments);

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

// The command line of glint bench.
#pragma once

#include "cli/bench/calibrate_arguments.h"
#include "cli/options/cache_options.h"
#include "cli/render/arguments.h"

#include <glint/measure/bench.h>

#include <string>
#include <vector>

namespace glint::cli {

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

}  // namespace glint::cli

// The command line of glint bench.
#pragma once

#include "cli/cache_options.h"
#include "cli/calibrate_arguments.h"
#include "cli/render_arguments.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glint {

// A package that is measured in addition to the configurations.
struct Candidate {
    std::string name;
    std::string folder;
};

struct BenchArguments {
    RenderArguments render;  // the default that everything is compared with
    std::string output;      // folder
    bool quick = false;
    std::int64_t rounds = 0;  // 0: by `quick`
    std::int64_t batch = 8;
    std::string depth = "search";
    std::vector<std::string> only;  // settings; empty: all
    std::string metric = "trimmed";
    double referenceError = 0.0;        // 0: by `quick`
    std::int64_t referenceSamples = 0;  // likewise
    std::vector<std::string> candidateWords;
    std::vector<Candidate> candidates;
    double budgetMs = 0.0;  // 0: none
    double maxError = 0.0;  // likewise
    CacheArguments cache;
    CalibrateArguments calibrate;

    std::string command;                 // to repeat it
    std::vector<std::string> viewWords;  // those that are no settings
};

void addBenchOptions(CLI::App& command, BenchArguments& arguments);
// Fills in the members that follow from the parsed `command`. Throws a CLI::ParseError if options contradict
// each other.
void settleBench(const CLI::App& command, BenchArguments& arguments);

}  // namespace glint

// Measures the cost of accuracy in time on a scene: `glint bench` without a command line.
//
//     Result<std::unique_ptr<BenchBed>> bed = BenchBed::create(observer, render, scene, nullptr);
//     BenchReport report;
//     Status done = runBench(observer, settings, plan, **bed, nullptr, report);
//     writeBench(report, "out/bench");
#pragma once

#include <glint/measure/bed.h>
#include <glint/measure/observer.h>
#include <glint/measure/report.h>

#include <cstdint>
#include <string>
#include <vector>

namespace glint::compiler {
class CacheStore;
}  // namespace glint::compiler

namespace glint::measure {

// A package that is measured in addition to the configurations.
struct Candidate {
    std::string name;
    std::string folder;
};

struct BenchSettings {
    std::string output;  // folder; it only names the advice's file
    bool quick = false;  // fewer values and pairs
    std::int64_t rounds = 11;
    std::int64_t batch = 8;
    std::string depth = "search";   // singles, pairs or search
    std::vector<std::string> only;  // settings; empty: all
    // Measures the default's picture filtered, alone and after 15 frames, and also one of 64 samples. Null:
    // no filter.
    const FilterMaker* filter = nullptr;
    ErrorMetric metric = ErrorMetric::Trimmed;
    // The reference has all of light transport. Otherwise it shares the default's effects, bounces and other
    // settings of light transport.
    std::string reference = "full";  // or same
    double referenceError = 0.005;
    std::int64_t referenceSamples = 16384;
    std::vector<Candidate> candidates;
    double budgetMs = 0.0;  // 0: none
    double maxError = 0.0;  // 0: none
};

// Makes the reference, measures one setting at a time, then pairs, then what a search proposes, and fills in
// the members of `report` that follow: scene but its file, machine, reference, base, settings, points, front,
// strategies, advice. The caller has set the others (file, rounds, seed, batch, quick, metric) before. A
// point that can't be measured is a warning. `store` keeps the reference; it may be null. Errors: of the
// reference and of the device, "validation".
Status runBench(const Observer& observer, const BenchSettings& settings, BenchBed& bed,
                compiler::CacheStore* store, BenchReport& report);

}  // namespace glint::measure

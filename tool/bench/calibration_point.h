// What a calibration measures at one generated scene: the input of the fit behind --strategy auto.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace glint::bench {

// A case of the scene: its share of all hits (1 over all cases), and what its shader holds.
struct CaseWork {
    double share = 0.0;
    double instructions = 0.0;  // of SPIR-V, in the module that `visibility` shades the case with
    double fetches = 0.0;       // of textures, likewise
};

// Milliseconds of the device for one sample, from the list of rays to their shaded hits: the median of the
// first strategy, times the median of this one's ratio to it in the same round, which a clock that changes
// between rounds leaves alone.
struct StrategyTime {
    std::string strategy;  // as --strategy has it
    double ms = 0.0;
};

struct CalibrationPoint {
    std::uint32_t cases = 0;
    std::string cost;            // "cheap" or "expensive"
    std::string coherence;       // "coherent" or "incoherent"
    double rays = 0.0;           // of the list, a sample
    double hitShare = 0.0;       // of rays that hit something
    double coherentShare = 0.0;  // of hits whose neighbours are alike: see coherentShareOf()
    std::vector<CaseWork> work;  // by shader ID
    std::vector<StrategyTime> times;
};

}  // namespace glint::bench

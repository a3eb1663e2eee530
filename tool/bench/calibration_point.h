// The measurements of a calibration at one generated scene: the input of the fit behind --strategy auto.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace glint::bench {

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

}  // namespace glint::bench

// What is measured: each function of shaders/ that needs no device, its inputs and how exact it must be.
#pragma once

#include "inputs.h"

#include <ostream>
#include <span>
#include <string_view>

namespace glint::numerics {

// An error is |value - truth| / max(|truth|, floorShare × scale).
struct Bounds {
    double worst = 1e-4;
    double median = 1e-6;
    double floorShare = 1e-6;
};

// Directions and positions have no relative precision in a component: their errors count against their
// length.
inline constexpr Bounds kVectorBounds{1e-5, 1e-6, 1.0};

// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding): in the order in which the table reads best
struct Probe {
    std::string_view name;      // in probes.glsl
    std::string_view function;  // what it measures, for people
    int inputs = 0;
    int outputs = 0;
    void (*fill)(InputSource&) = nullptr;
    Bounds bounds{};
    // After its outputs the probe gives their scale; without that it is 1.
    bool hasScale = false;
    // Last, the probe gives a number that says which way it decided. Where single and double precision decide
    // otherwise, near the edge, outputs are not compared; at most this share of the inputs may do so.
    double undecidedShare = -1.0;
    // Output 0 is how far away the nearest edge is at which the decision changes: deciding otherwise is an
    // error of as much.
    bool givesEdge = false;
    // The probe in textbook.glsl of the formula that the function stands in for, of the same inputs; may be
    // empty.
    std::string_view textbook = {};
    // The textbook's probe is compared with itself in double precision, not with ours: the two choose
    // differently (another frame, another origin), and each is to be exact about its own choice.
    bool textbookAgainstItself = false;

    // A probe that takes long is run for no more inputs than this; 0: as many as asked for.
    std::uint64_t inputLimit = 0;

    bool decides() const {
        return undecidedShare >= 0.0;
    }
    int allOutputs() const {
        return outputs + (hasScale ? 1 : 0) + (decides() ? 1 : 0);
    }
};

std::span<const Probe> allProbes();

// Its name, for messages.
inline std::ostream& operator<<(std::ostream& out, const Probe& probe) {
    return out << probe.name;
}

}  // namespace glint::numerics

// The list of measurements: each function of shaders/ that needs no device, its inputs and how exact it must
// be.
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

// Single components of directions and positions have no relative precision, so errors count relative to the
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
    // If set, the probe gives the scale of its outputs after them. Otherwise it is 1.
    bool hasScale = false;
    // If not negative, the probe's last number says how it decided. If single and double precision decide
    // differently near the edge, outputs are not compared. At most this share of the inputs may do so.
    double undecidedShare = -1.0;
    // If set, output 0 is the distance to the nearest edge at which the decision changes. A different
    // decision is an error of that size.
    bool givesEdge = false;
    // The probe in textbook.glsl with the textbook's formula for the same inputs; may be empty.
    std::string_view textbook = {};
    // If set, the textbook's probe is compared with itself in double precision, not with Glint's: the two
    // choose differently (another frame, another origin), and each must be exact about its own choice.
    bool textbookAgainstItself = false;

    // A slow probe runs for at most this many inputs; 0 for as many as asked for.
    std::uint64_t inputLimit = 0;

    bool decides() const {
        return undecidedShare >= 0.0;
    }
    int allOutputs() const {
        return outputs + (hasScale ? 1 : 0) + (decides() ? 1 : 0);
    }
};

std::span<const Probe> allProbes();

// Prints its name, for messages.
inline std::ostream& operator<<(std::ostream& out, const Probe& probe) {
    return out << probe.name;
}

}  // namespace glint::numerics

// The precision ladder: the cost of a function in instructions and in time, and its errors, in the textbook's
// form, in Glint's form, and in fewer or more bits.
#pragma once

#include "ladder_statistics.h"
#include "measure.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::numerics {

struct LadderOptions {
    std::uint64_t inputs = 200000;  // of a function, for its errors
    std::uint64_t seed = 1;         // of the inputs, and of the order of measurements
    int rounds = 15;
    double leastMilliseconds = 10.0;  // that a measurement takes on the device
    std::string function;             // measure it alone; empty: all
};

enum class RungKind : std::uint8_t {
    Textbook,  // 32 bits, the formula of textbook.glsl
    Single,    // 32 bits, ours
    Mixed,     // ours as --precision 16 computes it
    Half,      // ours, every operation in 16 bits
    Double     // ours, as C++ on one core of the host
};

std::string_view nameOf(RungKind kind);

// Errors against the truth, which is Glint's function as C++ in double precision.
struct RungErrors {
    double worst = 0.0;  // infinite where a result is not finite
    double median = 0.0;
    double notFinite = 0.0;  // share of the inputs
    double undecided = 0.0;  // share on which it decides otherwise than the truth, and is not compared
};

struct Rung {
    RungKind kind = RungKind::Single;
    // The instructions of the optimised SPIR-V; absent for C++.
    std::optional<std::uint32_t> instructions;
    Spread nanoseconds;  // an evaluation, over all threads of the device
    // Its times over the median of the textbook's form, or of Glint's form in 32 bits if there is none.
    // Absent if the time can't be told from that of the kernel around it.
    std::optional<Spread> ratio;
    bool tie = false;                  // of the times: the intervals overlap
    std::optional<RungErrors> errors;  // nothing of the truth
};

struct LadderRow {
    Probe probe;
    std::vector<Rung> rungs;

    const Rung* find(RungKind kind) const;
};

struct Ladder {
    std::string device;
    LadderOptions options;
    bool hasHalf = false;
    std::vector<LadderRow> rows;
};

// Compares the times of Glint's functions in 32 bits with the textbook's forms.
struct LadderCounts {
    int faster = 0;
    int slower = 0;
    int ties = 0;
    int unknown = 0;
};
LadderCounts countRungs(const Ladder& ladder);

// Returns the functions of the ladder: those that have a textbook form, and the main others.
std::vector<Probe> ladderProbes();

// Errors: those of the device; "timings-unavailable" if it has no timestamps.
Result<Ladder> climb(ProbeDevice& device, const LadderOptions& options);

}  // namespace glint::numerics

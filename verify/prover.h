// Proves claims about functions of shaders: for all inputs of a domain every operation is defined and finite,
// and every output lies in its range. Where bounds over a box of inputs are too wide, the box is split.
#pragma once

#include "verify/evaluate.h"
#include "verify/program.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint::verify {

enum class Scale : std::uint8_t {
    Linear,
    Logarithmic,  // boxes are split at the geometric mean; the least number is 0 or more
    Whole         // rounding errors of an input, which are never split
};

struct InputRange {
    std::string name;
    double low = 0.0;
    double high = 1.0;
    Scale scale = Scale::Linear;
};

struct OutputRange {
    std::string name;
    double low = -kLargestSingle;
    double high = kLargestSingle;
};

struct Claim {
    std::vector<InputRange> inputs;
    std::vector<OutputRange> outputs;
    // If set, there is a further output after the others, and the domain is where it is above 0.
    bool hasCondition = false;
};

struct ProofOptions {
    std::uint64_t mostBoxes = 20'000;
    std::uint64_t samples = 2'000;  // points that are tried before any box
    std::uint64_t seed = 1;
};

enum class ProofState : std::uint8_t { Proved, Undecided, Refuted };
const char* nameOf(ProofState state);

// An input for which the claim is wrong, evaluated in single precision.
struct Counterexample {
    std::vector<double> inputs;
    std::string what;  // "kept is 1.2, above 1", "division by zero: 1 / i[0]"
};

struct ProofResult {
    ProofState state = ProofState::Undecided;
    double undecidedShare = 1.0;  // of the domain's volume, in the scales of its inputs
    std::uint64_t boxes = 0;
    std::optional<Counterexample> counterexample;
    // The failure in the largest undecided box, as far as the bounds show it.
    std::vector<Interval> undecidedBox;
    std::string undecidedWhy;
};

// Requires a program whose inputs and outputs are those of the claim or more. The result does not depend on
// the machine's speed.
ProofResult prove(const Program& program, const Claim& claim, const ProofOptions& options);

// Checks one point in single precision; empty if the claim holds there, or if the point is not in the domain.
std::optional<std::string> refute(const Program& program, const Claim& claim, std::span<const double> inputs);

}  // namespace glint::verify

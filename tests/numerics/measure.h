// Runs a probe in all three ways and keeps the worst of what it sees.
#pragma once

#include "error_statistics.h"
#include "probe_device.h"
#include "probes.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint::numerics {

struct MeasureOptions {
    std::uint64_t inputs = 200000;
    std::uint64_t seed = 1;
};

// GLINT_NUMERIC_INPUTS and GLINT_NUMERIC_SEED of the environment, over the defaults.
MeasureOptions optionsFromEnvironment();

struct ProbeResult {
    std::uint64_t inputs = 0;
    std::uint64_t seed = 0;
    ErrorStatistics device;
    ErrorStatistics single;
    std::uint64_t undecided = 0;  // inputs on which the device decided otherwise than double precision
    std::optional<ErrorStatistics> textbook;  // on the device

    // On the device, in fewer bits.
    struct Fewer {
        ProbePrecision precision = ProbePrecision::Single;
        ErrorStatistics statistics;
        std::uint64_t undecided = 0;
    };
    std::vector<Fewer> fewer;
};

// Streams the inputs in batches; the truth is the probe in double precision over the same inputs.
// Errors: those of the device; "probe-name" where a probe is not in the text.
// `fewer`: what else to measure than 32 bits, on a device that has them.
Result<ProbeResult> measure(ProbeDevice& device, const Probe& probe, const MeasureOptions& options,
                            std::span<const ProbePrecision> fewer = {});

// Inputs of the probe: `count`, of those that measure() draws first.
std::vector<float> firstInputs(const Probe& probe, std::uint64_t seed, std::uint32_t count);

}  // namespace glint::numerics

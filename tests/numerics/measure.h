// Runs a probe in all three ways and keeps the worst errors.
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

// Returns GLINT_NUMERIC_INPUTS and GLINT_NUMERIC_SEED of the environment, or else the defaults.
MeasureOptions optionsFromEnvironment();

struct ProbeResult {
    std::uint64_t inputs = 0;
    std::uint64_t seed = 0;
    ErrorStatistics device;
    ErrorStatistics single;
    std::uint64_t undecided = 0;  // inputs on which the device decided otherwise than double precision
    std::optional<ErrorStatistics> textbook;  // on the device

    // The results on the device in fewer bits.
    struct Fewer {
        ProbePrecision precision = ProbePrecision::Single;
        ErrorStatistics statistics;
        std::uint64_t undecided = 0;
    };
    std::vector<Fewer> fewer;
};

// Streams the inputs in batches. The truth is the probe in double precision for the same inputs. `fewer`
// lists precisions to measure in addition to 32 bits, on a device that has them. Errors: those of the device;
// "probe-name" if a probe is not in the text.
Result<ProbeResult> measure(ProbeDevice& device, const Probe& probe, const MeasureOptions& options,
                            std::span<const ProbePrecision> fewer = {});

// Returns the first `count` inputs that measure() draws for the probe.
std::vector<float> firstInputs(const Probe& probe, std::uint64_t seed, std::uint32_t count);

}  // namespace glint::numerics

// Runs a probe in all three ways and keeps the worst of what it sees.
#pragma once

#include "probe_device.h"
#include "probes.h"

#include <array>
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

// The errors of one implementation against the truth.
class ErrorStatistics {
public:
    // `output` is the index of the output that has the error.
    void add(double error, int output, const float* inputs, int inputCount);
    void addNotFinite(int output, const float* inputs, int inputCount);
    void merge(const ErrorStatistics& other);

    double worst() const {
        return worst_;
    }
    int worstOutput() const {
        return worstOutput_;
    }
    const std::vector<float>& worstInputs() const {
        return worstInputs_;
    }
    std::uint64_t notFinite() const {
        return notFinite_;
    }
    // Upper edge of the bin, an eighth of an octave wide, that holds the median; 0 if most are exact.
    double median() const;

private:
    static constexpr int kBinsPerOctave = 8;
    static constexpr int kOctaves = 64;  // from 2^-63

    std::uint64_t exact_ = 0;
    std::array<std::uint64_t, kBinsPerOctave * kOctaves> bins_{};
    double worst_ = -1.0;
    int worstOutput_ = 0;
    std::vector<float> worstInputs_;
    std::uint64_t notFinite_ = 0;
};

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

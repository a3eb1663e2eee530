// Times kernels against each other: interleaved, in random order, for several rounds.
#pragma once

#include "probe_device.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace glint::numerics {

// The object of a measurement: a kernel on the device, or a function on one core of the host.
struct TimedKernel {
    std::size_t inputs = 0;                 // which list of inputs
    std::optional<ProbePipeline> pipeline;  // nothing: the host
    void (*call)(const double*, double*) = nullptr;
    std::size_t width = 0;              // numbers of an element, for the host
    std::uint32_t repeats = 0;          // found by calibration
    std::vector<double> nanoseconds{};  // an evaluation, by round
};

class KernelTimer {
public:
    // The number of elements whose evaluations are timed. They fit into a cache of any device.
    static constexpr std::uint32_t kElements = 4096;

    // A measurement takes at least `leastMilliseconds`. The device must outlive the timer.
    KernelTimer(ProbeDevice& device, double leastMilliseconds)
        : device_(device), leastMilliseconds_(leastMilliseconds) {}

    // Adds kElements elements. Returns the index of the list.
    std::size_t addInputs(std::vector<float> inputs);
    // Fills in repeats and nanoseconds. Every kernel runs once in each round, in an order that `seed`
    // decides. Has the errors of ProbeDevice::time().
    Status measure(std::span<TimedKernel* const> kernels, int rounds, std::uint64_t seed);

private:
    Status calibrate(TimedKernel& kernel);
    Result<double> milliseconds(const TimedKernel& kernel);
    double hostMilliseconds(const TimedKernel& kernel) const;
    std::uint32_t threads() const;

    ProbeDevice& device_;
    double leastMilliseconds_;
    std::vector<std::vector<float>> inputs_;
};

}  // namespace glint::numerics

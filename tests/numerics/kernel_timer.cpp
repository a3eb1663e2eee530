#include "kernel_timer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <random>
#include <utility>

namespace glint::numerics {
namespace {

// Enough threads to fill a GPU. A CPU is full with as many as it has lanes.
constexpr std::uint32_t kGpuThreads = 1U << 18U;
constexpr std::uint32_t kCpuThreads = 1U << 12U;
static_assert(kGpuThreads <= ProbeDevice::kMaxThreads && kCpuThreads <= ProbeDevice::kMaxThreads);
// With so many repeats, reading the inputs once does not count.
constexpr std::uint32_t kLeastRepeats = 16;
constexpr std::uint32_t kMostRepeats = 1U << 16U;

}  // namespace

std::size_t KernelTimer::addInputs(std::vector<float> inputs) {
    inputs_.push_back(std::move(inputs));
    return inputs_.size() - 1;
}

std::uint32_t KernelTimer::threads() const {
    return device_.isCpu() ? kCpuThreads : kGpuThreads;
}

// Times as many passes over all elements as there are repeats.
double KernelTimer::hostMilliseconds(const TimedKernel& kernel) const {
    const std::vector<double> inputs(inputs_[kernel.inputs].begin(), inputs_[kernel.inputs].end());
    std::array<double, kMaxOutputs> outputs{};
    const auto start = std::chrono::steady_clock::now();
    for (std::uint32_t repeat = 0; repeat < kernel.repeats; ++repeat) {
        for (std::size_t element = 0; element < kElements; ++element) {
            kernel.call(inputs.data() + element * kernel.width, outputs.data());
        }
    }
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

Result<double> KernelTimer::milliseconds(const TimedKernel& kernel) {
    if (!kernel.pipeline) {
        return hostMilliseconds(kernel);
    }
    device_.setInputs(inputs_[kernel.inputs]);
    return device_.time(*kernel.pipeline, kElements, threads(), kernel.repeats);
}

// Finds how often to repeat. The first runs also warm up.
Status KernelTimer::calibrate(TimedKernel& kernel) {
    kernel.repeats = kernel.pipeline ? kLeastRepeats : 1;
    while (kernel.repeats < kMostRepeats) {
        GLINT_TRY(const auto once, milliseconds(kernel));
        if (once >= leastMilliseconds_) {
            break;
        }
        kernel.repeats *= 2;
    }
    return okStatus();
}

Status KernelTimer::measure(std::span<TimedKernel* const> kernels, int rounds, std::uint64_t seed) {
    for (TimedKernel* kernel : kernels) {
        GLINT_TRY_DO(calibrate(*kernel));
    }
    std::vector<TimedKernel*> order(kernels.begin(), kernels.end());
    std::mt19937_64 engine(seed);
    for (int round = 0; round < rounds; ++round) {
        std::ranges::shuffle(order, engine);
        for (TimedKernel* kernel : order) {
            constexpr double kNanosecondsInOne = 1e6;
            GLINT_TRY(const auto time, milliseconds(*kernel));
            const double evaluations = static_cast<double>(kernel->pipeline ? threads() : kElements) *
                                       static_cast<double>(kernel->repeats);
            kernel->nanoseconds.push_back(time * kNanosecondsInOne / evaluations);
        }
    }
    return okStatus();
}

}  // namespace glint::numerics

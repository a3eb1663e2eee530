#include "error_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace glint::numerics {

void ErrorStatistics::add(double error, int output, const float* inputs, int inputCount) {
    if (error > worst_) {
        worst_ = error;
        worstOutput_ = output;
        worstInputs_.assign(inputs, inputs + inputCount);
    }
    if (error <= 0.0) {
        ++exact_;
        return;
    }
    const double bin = kBinsPerOctave * (std::log2(error) + kOctaves - 1);
    ++bins_[static_cast<std::size_t>(std::clamp(bin, 0.0, kBinsPerOctave * kOctaves - 1.0))];
}

void ErrorStatistics::addNotFinite(int output, const float* inputs, int inputCount) {
    ++notFinite_;
    add(std::numeric_limits<double>::infinity(), output, inputs, inputCount);
}

void ErrorStatistics::merge(const ErrorStatistics& other) {
    exact_ += other.exact_;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
        bins_[i] += other.bins_[i];
    }
    notFinite_ += other.notFinite_;
    if (other.worst_ > worst_) {
        worst_ = other.worst_;
        worstOutput_ = other.worstOutput_;
        worstInputs_ = other.worstInputs_;
    }
}

double ErrorStatistics::median() const {
    std::uint64_t total = exact_;
    for (const std::uint64_t bin : bins_) {
        total += bin;
    }
    std::uint64_t below = exact_;
    if (2 * below >= total) {
        return 0.0;
    }
    for (std::size_t i = 0; i < bins_.size(); ++i) {
        below += bins_[i];
        if (2 * below >= total) {
            return std::exp2(static_cast<double>(i + 1) / kBinsPerOctave - (kOctaves - 1));
        }
    }
    return std::numeric_limits<double>::infinity();
}

}  // namespace glint::numerics

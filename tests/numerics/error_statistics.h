// Collects the errors of many inputs: the worst with its inputs, and the median.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace glint::numerics {

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
    // Returns the upper edge of the bin that contains the median, an eighth of an octave wide; 0 if most
    // errors are 0.
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

}  // namespace glint::numerics

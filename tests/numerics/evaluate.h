// The probes of probes.glsl and textbook.glsl as C++ functions.
#pragma once

#include <span>
#include <string_view>

namespace glint::numerics {

// The arrays of every probe have room for this many.
inline constexpr int kMaxInputs = 64;
inline constexpr int kMaxOutputs = 24;

template <typename Real>
struct ProbeFunction {
    std::string_view name;
    void (*call)(const Real* inputs, Real* outputs) = nullptr;
};

// Returns every probe, in the order of the text. For float and double; evaluate.cpp is compiled for each.
template <typename Real>
std::span<const ProbeFunction<Real>> probeFunctions();
template <>
std::span<const ProbeFunction<float>> probeFunctions<float>();
template <>
std::span<const ProbeFunction<double>> probeFunctions<double>();

}  // namespace glint::numerics

// clang-format off
// Made by benchmarks/lights/fit_light_costs.py from benchmarks/data/lights; run it again rather than edit this.
//
// ClearCoatTest.gltf, NVIDIA H100 80GB HBM3: times off by 2.0 % (median), 11.2 % at most;
//     noise by a factor of 1.07 (median), 2.27 at most
// floor with boxes, NVIDIA H100 80GB HBM3: times off by 1.0 % (median), 3.5 % at most;
//     noise by a factor of 1.09 (median), 1.30 at most
#pragma once

#include <cstdint>

namespace glint::compiler::fitted {

// In nanoseconds of a sample of a pixel.
struct LightTimes {
    double rest;    // without lights
    double light;   // each light, where all are taken
    double sample;  // each sample of the hierarchy
    double level;   // the same for each doubling of the lights
};
inline constexpr LightTimes kLightScenes[] = {
    {0.483, 0.0941, 0.117, 0.00924},  // ClearCoatTest.gltf
    {0.467, 0.108, 0.15, 0.0137},  // floor with boxes
};

// With 32 samples, each takes 1.3 times as long.
inline constexpr std::uint32_t kLightSamples = 16;

// The relMse of a sample of a pixel with all lights.
inline constexpr double kPixelError = 0.00429;

// The relMse that K samples of n lights add: kNoise n^kNoiseOfLights (1 - K/n)^kNoiseOfRest / K^kNoiseOfSamples.
inline constexpr double kNoise = 0.00571;
inline constexpr double kNoiseOfLights = 0.708;
inline constexpr double kNoiseOfRest = 2.72;
inline constexpr double kNoiseOfSamples = 1.14;

}  // namespace glint::compiler::fitted

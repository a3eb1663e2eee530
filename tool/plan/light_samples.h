// Chooses how many samples a surface takes of a scene's lights: the model behind --lights auto.
//
// A surface has n lights that have a position. It can take all of them, or K samples that the hierarchy
// chooses. The time of a sample of a pixel is linear in constants:
//
//     all:        R + A n
//     K samples:  R + K (S + L log2 n)
//
// R is the time without lights. All lights are taken as long as they cost no more than fitted::kLightSamples
// samples in each scene that was measured. So a further light does not make the default faster. Where it
// changes, the samples are most of the lights, so that they have little noise.
//
// The constants are fitted to measurements (plan/light_constants.h), which also have the noise: with K, the
// product of time and error is near its minimum (docs/lights.md). A package is made without a device, so
// there is one set of them.
#pragma once

#include "plan/light_constants.h"

#include <cstddef>
#include <cstdint>

namespace glint::compiler {

// Returns the time of a sample of a pixel, in nanoseconds. `samples` is 0 for all lights, of which there are
// some.
double lightTime(const fitted::LightTimes& scene, std::size_t lights, std::uint32_t samples);

// The lights of a scene that a hierarchy may choose.
struct LightCounts {
    std::size_t positions = 0;  // point and spot lights
    std::size_t emitters = 0;   // emissive triangles
    bool areApart = false;      // beside the triangles, every surface takes all point and spot lights
};

// Returns the choice of --lights auto: a number of samples, or 0 for all lights.
std::uint32_t lightSamplesFor(const LightCounts& counts);

}  // namespace glint::compiler

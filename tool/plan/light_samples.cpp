#include "plan/light_samples.h"

#include <algorithm>
#include <cmath>

namespace glint::compiler {

namespace {

// Samples of emissive triangles grow with the cube root of their number, between these bounds. docs/lights.md
// has the measurements.
constexpr double kFewestOfEmitters = 2.0;
constexpr double kMostOfEmitters = 8.0;

std::uint32_t samplesOfEmitters(std::size_t emitters) {
    const double root = std::round(std::cbrt(static_cast<double>(emitters)));
    return static_cast<std::uint32_t>(std::clamp(root, kFewestOfEmitters, kMostOfEmitters));
}

bool takesAll(std::size_t lights) {
    return lights == 0 || std::ranges::all_of(fitted::kLightScenes, [&](const fitted::LightTimes& scene) {
               return lightTime(scene, lights, 0) <= lightTime(scene, lights, fitted::kLightSamples);
           });
}

}  // namespace

double lightTime(const fitted::LightTimes& scene, std::size_t lights, std::uint32_t samples) {
    const auto count = static_cast<double>(lights);
    const double each = scene.sample + scene.level * std::log2(count);
    return scene.rest + (samples == 0 ? scene.light * count : samples * each);
}

std::uint32_t lightSamplesFor(const LightCounts& counts) {
    if (counts.emitters == 0) {
        return takesAll(counts.positions) ? 0 : fitted::kLightSamples;
    }
    // With fewer samples, one further light that is apart from the triangles would make all of them cheap.
    return counts.areApart ? samplesOfEmitters(counts.emitters) : fitted::kLightSamples;
}

}  // namespace glint::compiler

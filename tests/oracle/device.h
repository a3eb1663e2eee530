// Renders scenes of the oracle's tests on the device.
#pragma once

#include "oracle/irradiance.h"
#include "oracle/light.h"
#include "oracle/occlusion.h"
#include "render/harness.h"

#include <cstdint>

namespace glint::oracle {

// Returns the samples of a test times GLINT_ORACLE_SAMPLES, which is 1 if it is not set.
std::uint32_t samplesOf(std::uint32_t samples);

// The settings of effects for a picture.
struct EffectOptions {
    std::uint32_t effects = 0;  // package::kEffect bits
    OcclusionSettings occlusion;
    std::uint32_t occlusionRays = 1;  // a sample
    LightSizes lights;
    bool findsLights = false;      // --sized-lights
    std::uint32_t shadowRays = 1;  // a light and sample
    float maxRoughness = 0.0F;     // of surfaces that reflect
    bool energyCompensation = true;
};

// Compiles the scene with these effects only, and renders it. If anything failed, the test fails and the
// picture is empty.
LinearImage renderEffect(const gltf::Scene& scene, const EffectOptions& options, testing::RenderSetup setup);

// Uses the scene's first camera.
testing::RenderSetup setupOf(const gltf::Scene& scene, std::uint32_t width, std::uint32_t height,
                             std::uint32_t samples, const GradientSky& sky);

}  // namespace glint::oracle

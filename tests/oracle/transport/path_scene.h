// What the tests of the path tracer share.
#pragma once

#include "oracle/expect.h"
#include "oracle/scene_file.h"
#include "oracle/transport/path_picture.h"

#include <optional>

namespace glint::oracle {

inline GradientSky uniformSky(double radiance) {
    return {Vec3(radiance), Vec3(radiance), Vec3(radiance)};
}

inline Ray rayTo(const Vec3& from, const Vec3& to) {
    return {from, glm::normalize(to - from)};
}

// Expects that the mean of samples is within five standard errors of the truth, and that these are at most
// `largest`. With thousands of samples five are exceeded once in a million; seeds are fixed.
inline void expectLight(const gltf::Scene& scene, const GradientSky& sky, const PathSettings& settings,
                        const Ray& ray, const Vec3& truth, double largest, std::uint32_t samples = 4000,
                        double floor = 1e-6) {
    const PathTracer tracer(scene, PathSky(sky), settings);
    const Estimate light = pathLight(tracer, ray, samples, 1);
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_LE(light.error[channel], largest) << "channel " << channel;
        EXPECT_NEAR(light.mean[channel], truth[channel], 5.0 * light.error[channel] + floor)
            << "channel " << channel;
    }
}

}  // namespace glint::oracle

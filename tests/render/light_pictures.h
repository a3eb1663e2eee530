// The tests of lights share this: quads as surfaces, and the means and errors of pictures.
#pragma once

#include "gltf/scene.h"
#include "render/harness.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace glint::testing {

void noLights(session::SceneViewData& data);
SkyView uniformSky(float radiance);

// Returns a diffuse surface that reflects nothing else.
materials::Material matte(float albedo);

// The mean over all pixels of one channel, or of red, green and blue.
double meanOf(const LinearImage& image, std::size_t channel);
double meanOf(const LinearImage& image);
// The mean of the squares of the differences of red, green and blue, and its root.
double meanSquare(const LinearImage& image, const LinearImage& reference);
double rootMeanSquare(const LinearImage& image, const LinearImage& reference);
// The sum over all pixels, red, green and blue.
double squaredDifference(const LinearImage& image, const LinearImage& reference);

// The mean of pictures with different seeds.
struct MeanEstimate {
    double mean = 0.0;
    double error = 0.0;  // standard error
};

// The mean of six pictures, whose seeds begin with `firstSeed`.
MeanEstimate estimateMean(std::uint32_t firstSeed,
                          const std::function<LinearImage(std::uint32_t seed)>& render);

// Whether two means agree within four of their errors; a share of `slack` is allowed beyond that. Means near
// 0 agree with none.
bool isSameMean(const MeanEstimate& a, const MeanEstimate& b, double slack = 1e-3);
void expectSameMean(const MeanEstimate& a, const MeanEstimate& b, const std::string& what,
                    double slack = 1e-3);

}  // namespace glint::testing

#include "render/light_pictures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace glint::testing {

void noLights(session::SceneViewData& data) {
    data.lights.clear();
}

SkyView uniformSky(float radiance) {
    const std::array<float, 3> sky{radiance, radiance, radiance};
    return {sky, sky, sky};
}

materials::Material matte(float albedo) {
    materials::Material material;
    material["baseColorFactor"] = {albedo, albedo, albedo, 1.0F};
    material["metallicFactor"] = 0.0F;
    material["roughnessFactor"] = 1.0F;
    material["specularFactor"] = 0.0F;
    return material;
}

double meanOf(const LinearImage& image, std::size_t channel) {
    double sum = 0.0;
    for (const auto& pixel : image.pixels) {
        sum += pixel[channel];
    }
    return sum / static_cast<double>(image.pixels.size());
}

double meanOf(const LinearImage& image) {
    return (meanOf(image, 0) + meanOf(image, 1) + meanOf(image, 2)) / 3.0;
}

double meanSquare(const LinearImage& image, const LinearImage& reference) {
    return squaredDifference(image, reference) / (3.0 * static_cast<double>(image.pixels.size()));
}

double rootMeanSquare(const LinearImage& image, const LinearImage& reference) {
    return std::sqrt(meanSquare(image, reference));
}

double squaredDifference(const LinearImage& image, const LinearImage& reference) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double difference = image.pixels[i][channel] - reference.pixels[i][channel];
            sum += difference * difference;
        }
    }
    return sum;
}

MeanEstimate estimateMean(std::uint32_t firstSeed,
                          const std::function<LinearImage(std::uint32_t seed)>& render) {
    constexpr std::uint32_t kPictures = 6;
    double sum = 0.0;
    double squares = 0.0;
    for (std::uint32_t i = 0; i < kPictures; ++i) {
        const double mean = meanOf(render(firstSeed + i));
        sum += mean;
        squares += mean * mean;
    }
    const double mean = sum / kPictures;
    return {mean, std::sqrt(std::max(squares / kPictures - mean * mean, 0.0) / (kPictures - 1))};
}

bool isSameMean(const MeanEstimate& a, const MeanEstimate& b, double slack) {
    return b.mean > 1e-3 && std::abs(a.mean - b.mean) < 4.0 * std::hypot(a.error, b.error) + slack * b.mean;
}

void expectSameMean(const MeanEstimate& a, const MeanEstimate& b, const std::string& what, double slack) {
    std::printf("%s: %.5f ± %.5f, expected %.5f ± %.5f\n", what.c_str(), a.mean, a.error, b.mean, b.error);
    EXPECT_TRUE(isSameMean(a, b, slack)) << what;
}

}  // namespace glint::testing

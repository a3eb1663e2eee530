#include "synthetic/textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

namespace glint::synthetic {

namespace {

using Pixel = std::array<double, 4>;  // each channel from 0 to 1

constexpr int kSize = 64;  // pixels a side; all textures stay in the caches, so that they cost their work
                           // alone

// `pixel` is a function of u and v in [0, 1).
template <typename Make>
gltf::Image makeImage(const std::string& name, int size, const Make& pixel) {
    gltf::Image image;
    image.name = name;
    image.width = size;
    image.height = size;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const Pixel value = pixel((x + 0.5) / size, (y + 0.5) / size);
            for (const double channel : value) {
                image.pixels.push_back(
                    static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(channel, 0.0, 1.0))));
            }
        }
    }
    return image;
}

double wave(double turns) {
    return std::sin(2.0 * std::numbers::pi * turns);
}

// Returns the normal of the height 0.02 sin(2 pi 4 u) sin(2 pi 4 v), from its slopes.
Pixel bump(double u, double v) {
    constexpr double kTurns = 4.0;
    constexpr double kSlope = 0.02 * 2.0 * std::numbers::pi * kTurns;
    const double x = -kSlope * wave(kTurns * u + 0.25) * wave(kTurns * v);
    const double y = -kSlope * wave(kTurns * u) * wave(kTurns * v + 0.25);
    const double length = std::sqrt(x * x + y * y + 1.0);
    return {0.5 + 0.5 * x / length, 0.5 + 0.5 * y / length, 0.5 + 0.5 / length, 1.0};
}

}  // namespace

void addTextures(gltf::Scene& scene) {
    constexpr double kMiddle = 128.0 / 255.0;
    scene.images = {
        makeImage("white", 4,
                  [](double, double) {
                      return Pixel{1.0, 1.0, 1.0, 1.0};
                  }),
        makeImage("flat", 4,
                  [](double, double) {
                      return Pixel{kMiddle, kMiddle, 1.0, 1.0};
                  }),
        makeImage("colors", kSize,
                  [](double u, double v) {
                      const double square = wave(2.0 * u) * wave(2.0 * v) > 0.0 ? 1.0 : 0.75;
                      return Pixel{square, square, square, 1.0};
                  }),
        makeImage("factors", kSize,
                  [](double u, double v) {
                      return Pixel{0.8 + 0.2 * wave(3.0 * u), 0.8 + 0.2 * wave(3.0 * v),
                                   0.8 + 0.2 * wave(u + v), 0.8 + 0.2 * wave(u - v)};
                  }),
        makeImage("bumps", kSize, bump),
    };
    scene.samplers = {gltf::Sampler{}};
    for (int i = 0; i < static_cast<int>(scene.images.size()); ++i) {
        scene.images[static_cast<std::size_t>(i)].pointer = "/images/" + std::to_string(i);
        scene.textures.push_back({i, 0});
    }
}

}  // namespace glint::synthetic

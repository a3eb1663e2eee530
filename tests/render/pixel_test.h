// The parts that tests of single pixels share.
#pragma once

#include "render/harness.h"
#include "render/scene_builder.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace glint::testing {

using Pixel = std::array<float, 4>;

inline Pixel at(const LinearImage& image, std::uint32_t x, std::uint32_t y) {
    return image.pixels[static_cast<std::size_t>(y) * image.width + x];
}

inline void expectColor(const Pixel& pixel, gltf::Float3 expected, float tolerance, const char* where) {
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(pixel[channel], expected[channel], tolerance) << where << ", channel " << channel;
    }
}

inline constexpr gltf::Float3 kRed{0.8F, 0.1F, 0.1F};
inline constexpr gltf::Float3 kGreen{0.1F, 0.7F, 0.1F};
inline constexpr gltf::Float3 kBlue{0.1F, 0.2F, 0.9F};

// Returns a square picture with the camera of addCamera(). The sky is white, so that ambient light is easy to
// compute.
inline RenderSetup squareSetup(const gltf::Scene& scene) {
    RenderSetup setup = defaultSetup(scene, 32, 32);
    setup.frame.sky = {{1.0F, 1.0F, 1.0F}, {1.0F, 1.0F, 1.0F}, {1.0F, 1.0F, 1.0F}};
    return setup;
}

// The same with a black sky and that many pixels each way.
inline RenderSetup darkSetup(const gltf::Scene& scene, std::uint32_t size = 32) {
    RenderSetup setup = squareSetup(scene);
    setup.width = size;
    setup.height = size;
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    return setup;
}

// Renders with the strategy of the parameter.
class PixelTest : public ::testing::TestWithParam<package::Strategy> {
protected:
    LinearImage render(const gltf::Scene& scene, const RenderSetup& setup,
                       package::AlphaPolicy alpha = package::AlphaPolicy::Opaque,
                       Renderer::Counters* counters = nullptr) {
        compiler::CompileSettings settings;
        settings.plan.keys.alpha = alpha;
        settings.plan.merge = compiler::MergePolicy::None;
        settings.energyCompensation = energyCompensation_;
        const LoadedScene loaded(scene, settings);
        return loaded.render(GetParam(), setup, counters);
    }

    bool energyCompensation_ = true;
};

inline const char* strategyName(const ::testing::TestParamInfo<package::Strategy>& strategy) {
    return strategy.param == package::kStrategyUber ? "Uber" : "Visibility";
}

}  // namespace glint::testing

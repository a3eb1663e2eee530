// Samples of the sky as shaders draw them: their density is that of the choice, and integrates to 1.
#include "render/hit_kernel.h"
#include "render/scene_builder.h"
#include "sky/environment.h"
#include "support/must.h"

#include <glint/environment.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

constexpr double kWhole = 4.0 * std::numbers::pi;
constexpr std::uint32_t kColumns = 256;  // those of the smallest map on the device
constexpr std::uint32_t kRows = 128;
constexpr std::uint32_t kDraws = kColumns * kRows;  // as many as directions

struct Drawn {
    std::array<double, 3> direction{};
    double density = 0.0;
    double evaluated = 0.0;  // for the same direction
    double there = 0.0;      // the density at the centre of the cell with this index
};

std::array<double, 3> centreOf(std::uint32_t index) {
    const double polar = std::numbers::pi * (index / kColumns + 0.5) / kRows;
    const double azimuth = 2.0 * std::numbers::pi * ((index % kColumns + 0.5) / kColumns - 0.5);
    return {std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)};
}

double solidAngleOf(std::uint32_t index) {
    const double above = std::cos(std::numbers::pi * (index / kColumns) / kRows);
    const double below = std::cos(std::numbers::pi * (index / kColumns + 1) / kRows);
    return 2.0 * std::numbers::pi / kColumns * (above - below);
}

// Stratified random numbers of 24 bits.
std::vector<Drawn> draw(bool isMap, const gpu::FrameConstants& constants) {
    gltf::Scene scene = sceneWithCamera();
    const int mesh = addMesh(
        scene, makeQuad(addMaterial(scene, materials::Material()), {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}));
    addInstance(scene, mesh);
    const LoadedScene loaded(scene, compiler::PlanOptions{});
    compiler::CompileSettings settings;
    settings.skyLight = compiler::SkyLight::On;
    settings.environmentMap = isMap;
    const std::unique_ptr<HitKernel> kernel =
        must(HitKernel::create(scene, loaded, "sky_samples.comp", settings));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto grid = [](double value) {
        return static_cast<float>(std::floor(value * 16777216.0) / 16777216.0);
    };
    std::vector<gpu::RayRecord> rays(kDraws);
    for (std::uint32_t i = 0; i < kDraws; ++i) {
        rays[i].origin = {grid((i / kColumns + unit(random)) / kRows),
                          grid((i % kColumns + unit(random)) / kColumns), 0.0F};
        const std::array<double, 3> centre = centreOf(i);
        rays[i].direction = {static_cast<float>(centre[0]), static_cast<float>(centre[1]),
                             static_cast<float>(centre[2])};
        rays[i].coneWidth = static_cast<float>(unit(random) * 0.999);
        rays[i].coneSpread = static_cast<float>(unit(random) * 0.999);
    }
    const std::vector<std::uint32_t> words =
        must(kernel->run(constants, rays, kDraws, std::size_t{6} * kDraws));
    std::vector<Drawn> drawn(kDraws);
    for (std::uint32_t i = 0; i < kDraws; ++i) {
        const auto at = [&](std::size_t word) {
            return static_cast<double>(std::bit_cast<float>(words[6 * i + word]));
        };
        drawn[i] = {{at(0), at(1), at(2)}, at(3), at(4), at(5)};
    }
    return drawn;
}

// Returns what is wrong with samples whose densities are multiplied by `fault`, or an empty text. The sphere
// is divided into 8 x 16 parts, and each is expected to have the samples that the integral of the density
// says.
std::string flawOf(const std::vector<Drawn>& drawn, double fault = 1.0) {
    double integral = 0.0;
    std::array<double, 128> expected{};
    std::array<double, 128> seen{};
    std::uint32_t apart = 0;
    const auto partOf = [](std::uint32_t row, std::uint32_t column) {
        return row * 8 / kRows * 16 + column * 16 / kColumns;
    };
    for (std::uint32_t i = 0; i < drawn.size(); ++i) {
        integral += fault * drawn[i].there * solidAngleOf(i);
        expected[partOf(i / kColumns, i % kColumns)] += fault * drawn[i].there * solidAngleOf(i) * kDraws;
        const std::array<double, 3>& d = drawn[i].direction;
        const double length = std::hypot(d[0], d[1], d[2]);
        if (std::abs(length - 1.0) > 1e-5 || !(drawn[i].density > 0.0)) {
            return "a direction or density is wrong: " + std::to_string(i);
        }
        const double row = std::acos(std::clamp(d[1], -1.0, 1.0)) / std::numbers::pi * kRows;
        const double column = (std::atan2(d[2], d[0]) / (2.0 * std::numbers::pi) + 0.5) * kColumns;
        ++seen[partOf(std::min(static_cast<std::uint32_t>(row), kRows - 1),
                      std::min(static_cast<std::uint32_t>(column), kColumns - 1))];
        // Rounding puts some directions into the neighbouring cell.
        apart += std::abs(fault * drawn[i].evaluated / drawn[i].density - 1.0) > 1e-4 ? 1 : 0;
    }
    if (std::abs(integral - 1.0) > 2e-3) {
        return "the density integrates to " + std::to_string(integral);
    }
    if (apart > kDraws / 500) {
        return "the density of a sample is another than that of its direction: " + std::to_string(apart);
    }
    for (std::size_t part = 0; part < seen.size(); ++part) {
        // Stratified samples vary less than Poisson's.
        if (std::abs(seen[part] - expected[part]) > 4.0 * std::sqrt(expected[part]) + 4.0) {
            return "part " + std::to_string(part) + " has " + std::to_string(seen[part]) +
                   " samples instead of " + std::to_string(expected[part]);
        }
    }
    return "";
}

using Texel = std::function<float(std::uint32_t, std::uint32_t)>;

std::vector<Drawn> drawMap(std::uint32_t width, std::uint32_t height, const Texel& texel, float turn = 0.0F) {
    LinearImage image{width, height, {}};
    for (std::uint32_t i = 0; i < width * height; ++i) {
        const float value = texel(i % width, i / width);
        image.pixels.push_back({value, value, value, 1.0F});
    }
    const std::unique_ptr<Environment> map =
        must(Environment::create(sharedContext(), image, {.sampled = true}));
    const Environment::State& state = *map->state();
    EXPECT_EQ(state.countColumns, kColumns);
    EXPECT_EQ(state.countRows, kRows);
    gpu::FrameConstants constants{};
    constants.environmentTurn = turn;
    constants.skyCounts = state.counts.address;
    constants.skyColumns = state.countColumns;
    constants.skyRows = state.countRows;
    return draw(true, constants);
}

TEST(SkySamples, MapsAreChosenByTheirLuminance) {
    const auto hills = [](std::uint32_t x, std::uint32_t y) {
        return 0.2F + static_cast<float>((x * 7 + y * 5) % 11);
    };
    const auto sun = [](std::uint32_t x, std::uint32_t y) { return x == 20 && y == 3 ? 1e6F : 0.5F; };
    const std::vector<Drawn> drawn = drawMap(32, 16, hills);
    EXPECT_EQ(flawOf(drawn), "");
    EXPECT_NE(flawOf(drawn, 1.02), "") << "a density that is wrong by 2 % has to be found";
    EXPECT_EQ(flawOf(drawMap(32, 16, sun)), "");
    EXPECT_EQ(flawOf(drawMap(32, 16, hills, 0.3F)), "") << "turned";
    EXPECT_EQ(flawOf(drawMap(kColumns, kRows, sun)), "") << "one bright texel of the map";
}

// Every direction of a map without light, or of one texel, is as likely as any other.
TEST(SkySamples, BlackAndUniformMapsAreUniform) {
    for (const float value : {0.0F, 3.0F}) {
        const std::vector<Drawn> drawn = drawMap(1, 1, [&](std::uint32_t, std::uint32_t) { return value; });
        EXPECT_EQ(flawOf(drawn), "");
        for (std::size_t i = 0; i < drawn.size(); i += 97) {
            EXPECT_NEAR(drawn[i].density * kWhole, 1.0, 2e-3);
        }
    }
}

TEST(SkySamples, TheGradientIsChosenByItsLuminance) {
    gpu::FrameConstants constants{};
    EXPECT_EQ(flawOf(draw(false, constants)), "") << "black";
    constants.skyZenith = {2.0F, 3.0F, 4.0F};
    constants.skyHorizon = {1.0F, 1.0F, 0.5F};
    constants.skyGround = {0.0F, 0.0F, 0.0F};
    const std::vector<Drawn> drawn = draw(false, constants);
    EXPECT_EQ(flawOf(drawn), "");
    EXPECT_NE(flawOf(drawn, 1.02), "") << "a density that is wrong by 2 % has to be found";
    // The share of the radiance in the density is nearly constant, so the estimate of the flux has hardly any
    // noise.
    double flux = 0.0;
    for (const Drawn& sample : drawn) {
        const double up = sample.direction[1];
        const double horizon = 0.2126 + 0.7152 + 0.0722 * 0.5;
        const double pole = up >= 0.0 ? 0.2126 * 2 + 0.7152 * 3 + 0.0722 * 4 : 0.0;
        flux += (horizon + (pole - horizon) * std::abs(up)) / sample.density / kDraws;
    }
    const double expected = kWhole / 4.0 * (2.0 * (0.2126 + 0.7152 + 0.0361) + 0.4252 + 2.1456 + 0.2888);
    EXPECT_NEAR(flux / expected, 1.0, 1e-3);
}

}  // namespace

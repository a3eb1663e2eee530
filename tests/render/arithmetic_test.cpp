// Tests functions of the hit shaders in which single precision could fail: directions of any length, means of
// many samples.
#include "render/hit_kernel.h"
#include "render/scene_builder.h"
#include "support/must.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

using Double3 = std::array<double, 3>;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// The kernels here read no scene, but have to be compiled for one.
gltf::Scene anyScene() {
    gltf::Scene scene = emptyScene();
    const int material = addMaterial(scene, unlitMaterial({1, 1, 1}));
    addQuad(scene, material, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    return scene;
}

Double3 unitOf(const Double3& v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}

TEST(Directions, OfEveryLength) {
    std::vector<Double3> vectors;
    for (int exponent = -37; exponent <= 37; ++exponent) {
        const double scale = std::pow(10.0, exponent);
        vectors.push_back({0.3 * scale, -scale, 0.7 * scale});
        vectors.push_back({0.0, 0.0, -scale});
    }
    std::vector<gpu::RayRecord> rays;
    for (const Double3& vector : vectors) {
        gpu::RayRecord ray{};
        ray.direction = {static_cast<float>(vector[0]), static_cast<float>(vector[1]),
                         static_cast<float>(vector[2])};
        rays.push_back(ray);
    }
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const gpu::vec3 none : {gpu::vec3{0, 0, 0}, gpu::vec3{kInfinity, 0, 0}, gpu::vec3{0, -kInfinity, 1},
                                 gpu::vec3{nan, 0, 0}, gpu::vec3{1, nan, 2}, gpu::vec3{1, 2, nan}}) {
        rays.emplace_back().direction = none;
    }
    const gltf::Scene scene = anyScene();
    const LoadedScene loaded(scene, compiler::PlanOptions{});
    const std::unique_ptr<HitKernel> kernel = must(HitKernel::create(scene, loaded, "direction_or.comp"));
    const auto count = static_cast<std::uint32_t>(rays.size());
    const std::vector<std::uint32_t> words = must(kernel->run({}, rays, count, 3 * rays.size()));
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Double3 got{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            got[axis] = std::bit_cast<float>(words[3 * i + axis]);
        }
        const Double3 expected = i < vectors.size() ? unitOf(vectors[i]) : Double3{2, 2, 2};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(got[axis], expected[axis], 5e-7) << "vector " << i << ", axis " << axis;
        }
    }
}

// Repeats shaders/hit/random.glsl on the host.
std::uint32_t pcgHash(std::uint32_t value) {
    const std::uint32_t state = value * 747796405U + 2891336453U;
    const std::uint32_t word = ((state >> ((state >> 28U) + 4U)) ^ state) * 277803737U;
    return (word >> 22U) ^ word;
}

TEST(RunningMean, OfManySamplesIsThatInDoublePrecision) {
    constexpr std::uint32_t kSamples = 100'000;
    constexpr std::uint32_t kPixels = 64;
    constexpr std::uint32_t kSeed = 7;
    const gltf::Scene scene = anyScene();
    const LoadedScene loaded(scene, compiler::PlanOptions{});
    const std::unique_ptr<HitKernel> kernel = must(HitKernel::create(scene, loaded, "running_mean.comp"));
    gpu::FrameConstants constants{};
    constants.sampleIndex = kSamples;
    constants.seed = kSeed;
    const std::vector<std::uint32_t> words = must(kernel->run(constants, {}, kPixels, 3 * kPixels));
    Double3 largest{};
    for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
        Double3 sums{};
        for (std::uint32_t i = 0; i < kSamples; ++i) {
            const std::uint32_t bits = pcgHash(pixel + pcgHash(i + pcgHash(0U + pcgHash(kSeed))));
            const float random = static_cast<float>(bits >> 8U) / 16777216.0F;
            sums[0] += random;
            sums[1] += 1.0F + random / 512.0F;
            sums[2] += random < 1.0F / 1024.0F ? 4096.0F : 0.5F;
        }
        for (std::size_t kind = 0; kind < 3; ++kind) {
            const double mean = sums[kind] / kSamples;
            const double got = std::bit_cast<float>(words[3 * pixel + kind]);
            largest[kind] = std::max(largest[kind], std::abs(got - mean) / mean);
        }
    }
    for (std::size_t kind = 0; kind < 3; ++kind) {
        RecordProperty("relativeError" + std::to_string(kind), std::to_string(largest[kind]));
        std::cout << "largest relative error of kind " << kind << ": " << largest[kind] << "\n";
        // The bound is one rounding of the mean, plus what the residuals' own rounding leaves.
        EXPECT_LE(largest[kind], 2e-7) << "kind " << kind;
    }
}

}  // namespace

// Glossy reflections converge to one picture with every strategy.
#include "render/harness.h"
#include "render/light_pictures.h"
#include "render/rooms.h"
#include "support/nightly.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

constexpr std::uint32_t kWidth = 24;
constexpr std::uint32_t kHeight = 16;

// Removes highlights of point lights in smooth surfaces: a rare sample of one is as bright as the lobe is
// narrow, and no picture of 4,096 samples has found them all.
gltf::Scene roomWithoutSharpHighlights() {
    gltf::Scene scene = roomOfMaterials();
    for (materials::Material& material : scene.materials) {
        material["roughnessFactor"] = std::max<float>(material["roughnessFactor"], 0.25F);
        material["clearcoatRoughnessFactor"] = 0.4F;
    }
    return scene;
}

class Convergence : public ::testing::Test {
protected:
    Convergence() : scene_(roomWithoutSharpHighlights()) {
        compiler::CompileSettings settings;
        settings.strategies =
            test::nightly() ? package::allStrategies() : std::uint32_t{package::kStrategyUber};
        settings.plan.merge = compiler::MergePolicy::All;
        loaded_.emplace(scene_, settings);
    }

    LinearImage render(package::Strategy strategy, std::uint32_t samples, std::uint32_t seed) {
        RenderSetup setup = defaultSetup(scene_, kWidth, kHeight);
        setup.frame.maxReflectionRoughness = 1.0F;
        setup.frame.seed = seed;
        setup.samples = samples;
        return loaded_->render(strategy, setup);
    }

    gltf::Scene scene_;
    std::optional<LoadedScene> loaded_;
};

// The slope of error over samples, log over log, is -0.5 for independent samples. The scrambled sequence is
// steeper where the function that it samples is smooth.
TEST_F(Convergence, ErrorFallsWithTheRootOfTheSamples) {
    const LinearImage reference = render(package::kStrategyUber, 4096, 1);
    double sumX = 0.0;
    double sumY = 0.0;
    double sumXX = 0.0;
    double sumXY = 0.0;
    int points = 0;
    for (std::uint32_t samples = 2; samples <= 64; samples *= 2) {
        double squares = 0.0;
        constexpr int kSeeds = 4;
        for (std::uint32_t seed = 2; seed < 2 + kSeeds; ++seed) {
            const LinearImage image = render(package::kStrategyUber, samples, seed);
            const double error = rootMeanSquare(image, reference);
            squares += error * error / kSeeds;
        }
        const double x = std::log2(samples);
        const double y = 0.5 * std::log2(squares);
        std::printf("%u samples: error %.5f\n", samples, std::sqrt(squares));
        sumX += x;
        sumY += y;
        sumXX += x * x;
        sumXY += x * y;
        ++points;
    }
    const double slope = (points * sumXY - sumX * sumY) / (points * sumXX - sumX * sumX);
    std::printf("slope %.3f\n", slope);
    EXPECT_NEAR(slope, -0.5, 0.1);
}

// Each strategy has its own seeds. By day StrategiesAgree and its like compare pictures of the same seed.
TEST_F(Convergence, StrategiesHaveTheSameMean) {
    if (!test::nightly()) {
        GTEST_SKIP() << "GLINT_NIGHTLY is not set";
    }
    constexpr int kSeeds = 12;
    struct Estimate {
        double mean = 0.0;
        double error = 0.0;  // standard error of the mean
    };
    std::vector<Estimate> estimates;
    std::uint32_t seed = 100;
    for (const package::Strategy strategy : package::strategies()) {
        std::vector<double> means;
        for (int k = 0; k < kSeeds; ++k) {
            const LinearImage image = render(strategy, 16, seed++);
            means.push_back(meanOf(image));
        }
        Estimate estimate;
        for (const double value : means) {
            estimate.mean += value / kSeeds;
        }
        double squares = 0.0;
        for (const double value : means) {
            squares += (value - estimate.mean) * (value - estimate.mean);
        }
        estimate.error = std::sqrt(squares / (kSeeds * (kSeeds - 1.0)));
        EXPECT_GT(estimate.error, 0.0);
        estimates.push_back(estimate);
    }
    for (const Estimate& a : estimates) {
        for (const Estimate& b : estimates) {
            // The bound is four standard errors of the difference. As seeds are fixed, a bias shows and
            // chance does not.
            EXPECT_NEAR(a.mean, b.mean, 4.0 * std::hypot(a.error, b.error));
        }
    }
}

}  // namespace

// What --lights auto takes, by its model of time and noise and by the measurements behind it.
#include "base/json.h"
#include "resolve/light.h"

#include <glint/internal/package_format.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <interop/lights.h>
#include <iterator>
#include <map>
#include <string>
#include <utility>

namespace {

using namespace glint;
using namespace glint::compiler;

constexpr std::size_t kMostTested = 4096;

std::uint32_t samplesFor(std::size_t positions, std::size_t emitters = 0) {
    const bool areApart = emitters > 0 && positions <= gpu::kMostLightsApart;
    return lightSamplesFor({.positions = positions, .emitters = emitters, .areApart = areApart});
}

// The error that samples add to that of a pixel with all lights, by the fit.
double noiseOf(std::size_t lights, std::uint32_t samples) {
    using namespace fitted;
    const auto count = static_cast<double>(lights);
    return samples == 0
               ? 0.0
               : kNoise * std::pow(count, kNoiseOfLights) * std::pow(1.0 - samples / count, kNoiseOfRest) /
                     std::pow(static_cast<double>(samples), kNoiseOfSamples);
}

// The geometric mean over the scenes of the time at equal error, which is the product of time and error.
double timeAtEqualError(std::size_t lights, std::uint32_t samples) {
    double logarithms = 0.0;
    for (const fitted::LightTimes& scene : fitted::kLightScenes) {
        logarithms += std::log(lightTime(scene, lights, samples));
    }
    const double time = std::exp(logarithms / static_cast<double>(std::size(fitted::kLightScenes)));
    return time * (fitted::kPixelError + noiseOf(lights, samples));
}

TEST(LightSamples, AFurtherLightMakesNoFrameFaster) {
    for (const fitted::LightTimes& scene : fitted::kLightScenes) {
        double before = lightTime(scene, 1, samplesFor(1));
        for (std::size_t lights = 2; lights <= kMostTested; ++lights) {
            const double time = lightTime(scene, lights, samplesFor(lights));
            EXPECT_GE(time, before) << lights << " lights";
            EXPECT_LE(time, 1.25 * before) << lights << " lights";
            before = time;
        }
    }
}

TEST(LightSamples, TheDefaultIsNearTheBestOfEqualError) {
    double worst = 0.0;
    for (std::size_t lights = 1; lights <= kMostTested; ++lights) {
        double best = timeAtEqualError(lights, 0);
        const auto most = static_cast<std::uint32_t>(std::min<std::size_t>(lights, fitted::kLightSamples));
        for (std::uint32_t samples = 1; samples <= most; ++samples) {
            best = std::min(best, timeAtEqualError(lights, samples));
        }
        const double ratio = timeAtEqualError(lights, samplesFor(lights)) / best;
        EXPECT_LE(ratio, 1.3) << lights << " lights";
        worst = std::max(worst, ratio);
    }
    std::printf("at most %.2f of the best\n", worst);
}

TEST(LightSamples, FewLightsAreTakenWholeAndManyAreNot) {
    EXPECT_EQ(samplesFor(0), 0U);
    EXPECT_EQ(samplesFor(1), 0U);
    EXPECT_EQ(samplesFor(8), 0U);
    EXPECT_GT(samplesFor(128), 0U);
    EXPECT_EQ(samplesFor(1'000'000), samplesFor(kMostTested));
    EXPECT_LE(samplesFor(kMostTested), package::kMaxLightSamples);
    EXPECT_GE(samplesFor(kMostTested), samplesFor(128));
}

// Beside triangles that emit light, one point light more than every surface takes does not make them all
// cheap.
TEST(LightSamples, TrianglesAndPointLightsAddTheirSamples) {
    EXPECT_EQ(samplesFor(0, 1), 2U);
    EXPECT_EQ(samplesFor(0, 64), 4U);
    EXPECT_EQ(samplesFor(0, 512), 8U);
    EXPECT_EQ(samplesFor(0, 1'000'000), 8U);
    EXPECT_EQ(samplesFor(gpu::kMostLightsApart, 64), 4U);
    std::uint32_t fewer = samplesFor(0, 1);
    for (std::size_t emitters = 2; emitters < 1000; ++emitters) {
        const std::uint32_t samples = samplesFor(0, emitters);
        EXPECT_TRUE(samples == fewer || samples == fewer + 1) << emitters << " triangles";
        fewer = samples;
    }
    const std::size_t more = gpu::kMostLightsApart + 1;
    EXPECT_LE(samplesFor(more, 1'000'000), package::kMaxLightSamples);
    for (const fitted::LightTimes& scene : fitted::kLightScenes) {
        EXPECT_GE(lightTime(scene, more, samplesFor(more, 64)), lightTime(scene, gpu::kMostLightsApart, 0));
    }
}

struct Measured {
    double time = 0.0;   // of a frame, milliseconds
    double noise = 0.0;  // relMse
};
// By the number of lights and of samples, 0 for all.
using Measurement = std::map<std::size_t, std::map<std::uint32_t, Measured>>;

// The settings that the file has, apart from those of an older program.
Measurement readMeasurement(const std::string& name) {
    Measurement result;
    std::ifstream file(std::string(GLINT_SOURCE_DIR "/benchmarks/data/lights/") + name + ".json");
    EXPECT_TRUE(file) << name;
    const base::Json report = base::Json::parse(file);
    for (const base::Json& row : report.at("results")) {
        const std::string choice = row.at("choice");
        if (choice.find(' ') == std::string::npos) {
            const auto samples = choice == "all" ? 0U : static_cast<std::uint32_t>(std::stoul(choice));
            result[row.at("lights")][samples] = {row.at("frameMilliseconds").at(0), row.at("relMseOfSample")};
        }
    }
    return result;
}

TEST(LightSamples, NoMeasuredSettingHasAsLittleNoiseInMuchLessTime) {
    int compared = 0;
    for (const char* const name : {"model_clearcoat", "model_floor", "default_clearcoat", "default_floor"}) {
        for (const auto& [lights, settings] : readMeasurement(name)) {
            const Measured& own = settings.at(samplesFor(lights));
            for (const auto& [samples, other] : settings) {
                if (other.noise <= own.noise) {
                    ++compared;
                    EXPECT_LE(own.time, 1.3 * other.time) << name << ", " << lights << " lights, " << samples;
                }
            }
        }
    }
    EXPECT_GT(compared, 50);
}

TEST(LightSamples, MeasuredTimesOfTheDefaultGrow) {
    for (const char* const name : {"default_clearcoat", "default_floor"}) {
        double before = 0.0;
        for (const auto& [lights, settings] : readMeasurement(name)) {
            const double time = settings.at(samplesFor(lights)).time;
            EXPECT_GT(time, 0.98 * before) << name << ", " << lights << " lights";
            before = time;
        }
    }
}

}  // namespace

#include "frame/frame_constants.h"

#include "scene/instance_math.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint {
namespace {

// Shaders turn the direction of a lookup, and the host turns the harmonics.
void fillEnvironment(const Environment::State& environment, const Outside& outside,
                     gpu::FrameConstants& constants) {
    const SkyHarmonics harmonics = turned(environment.harmonics, outside.rotation);
    for (std::size_t i = 0; i < harmonics.size(); ++i) {
        const auto channel = [&](std::size_t c) {
            return static_cast<float>(harmonics[i][c] * outside.intensity);
        };
        constants.skyHarmonics[i] = {channel(0), channel(1), channel(2)};
    }
    const double turns = outside.rotation / (2.0 * std::numbers::pi);
    constants.environmentLevels = static_cast<float>(environment.statistics.levels);
    constants.environmentTurn = static_cast<float>(turns - std::floor(turns));
    constants.environmentScale = environment.scale * outside.intensity;
    constants.skyCounts = environment.counts.address;
    constants.skyColumns = environment.countColumns;
    constants.skyRows = environment.countRows;
}

}  // namespace

Status checkOutside(const FrameSize& size, const Outside& outside) {
    for (const std::array<float, 3>& radiance :
         {outside.sky.zenith, outside.sky.horizon, outside.sky.ground}) {
        if (!std::ranges::all_of(radiance,
                                 [](float value) { return std::isfinite(value) && value >= 0.0F; })) {
            return makeError("sky", "", "the sky's radiance is negative or not finite",
                             "give three finite numbers of at least 0");
        }
    }
    if (size.environmentMap && outside.environment == nullptr) {
        return makeError("environment-missing", "",
                         "the package reads an environment map, and the frame has none",
                         "set FrameOptions::environment, or compile the package without an environment map");
    }
    if (size.skyLight && outside.environment != nullptr && !outside.environment->statistics().sampled) {
        return makeError("environment-unsampled", "",
                         "the package samples the sky as a light, and the environment map can't be sampled",
                         "create it with EnvironmentOptions::sampled, or compile with --no-sky-light");
    }
    if (!size.environmentMap && outside.environment != nullptr) {
        return makeError(
            "environment-unread", "",
            "the frame has an environment map, and the package was compiled without one",
            "compile the package for an environment map, or leave FrameOptions::environment null");
    }
    if (!std::isfinite(outside.rotation) || !std::isfinite(outside.intensity) || outside.intensity < 0.0F) {
        return makeError(
            "frame-options", "",
            "environmentRotation is not finite, or environmentIntensity is negative or not finite",
            "use radians, and a factor of at least 0");
    }
    return okStatus();
}

void fillOutside(const Outside& outside, gpu::FrameConstants& constants) {
    constants.skyZenith = toVec3(outside.sky.zenith);
    constants.skyHorizon = toVec3(outside.sky.horizon);
    constants.skyGround = toVec3(outside.sky.ground);
    if (outside.environment != nullptr) {
        fillEnvironment(*outside.environment->state(), outside, constants);
    }
}

void fillLists(const FrameResources& frame, const FrameSize& size, gpu::FrameConstants& constants) {
    constants.bucketCount = size.bucketCount;
    constants.bucketAlignment = size.bucketAlignment;
    constants.sampleStarts = frame.sampleStarts.address;
    constants.sampleAims = frame.sampleAims.address;
    constants.sampleWeights = frame.sampleWeights.address;
    constants.radiance = frame.radiance.address;
    constants.listed = frame.listed.address;
    constants.nextListed = frame.nextListed.address;
    constants.paths = frame.paths.address;
    constants.lobeRays = frame.lobeRays.address;
    constants.skyShares = frame.skyShares.address;
    constants.rayHits = frame.rayHits.address;
    constants.bounceLight = frame.bounceLight.address;
    constants.walkedLight = frame.walkedLight.address;
    constants.hits = frame.hits.address;
    constants.packedHits = frame.hits.address;
    constants.shadows = frame.shadows.address;
    constants.shadowDispatch = frame.shadowDispatch.address;
    constants.orderedHits = frame.orderedHits.address;
    constants.visitedHits = frame.visitedHits.address;
    constants.bucketKeys = frame.bucketKeys.address;
    constants.bucketCounts = frame.bucketCounts.address;
    constants.bucketBegins = frame.bucketBegins.address;
    constants.bucketCursors = frame.bucketCursors.address;
    constants.rayDispatch = frame.rayDispatch.address;
    constants.bucketDispatch = frame.bucketDispatch.address;
    constants.counters = frame.counters.address;
}

void setBand(const FrameSize& size, std::uint32_t band, gpu::FrameConstants& constants) {
    constants.firstRow = band * size.rowsOfBand();
    constants.endRow = std::min(constants.firstRow + size.rowsOfBand(), size.height);
    constants.bandFirst = constants.firstRow * size.width;
    constants.outsideBands =
        static_cast<std::uint32_t>(VkDeviceSize{size.width} * size.height - size.pixelsOfBand());
}

}  // namespace glint

#include "frame/frame_constants.h"

#include "data/instance_math.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

namespace glint {
namespace {

glm::vec3 toVector(const std::array<float, 3>& v) {
    return {v[0], v[1], v[2]};
}

gpu::vec3 toRecord(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}

gpu::vec4 toRecord(const glm::vec4& v) {
    return {v.x, v.y, v.z, v.w};
}

// Returns the row that takes a point to dot(axis, point - position) * factor.
glm::vec4 rowAlong(const glm::vec3& axis, const glm::vec3& position, float factor) {
    return glm::vec4(axis, -glm::dot(axis, position)) * factor;
}

bool isUnit(const glm::vec3& v) {
    // Four digits are enough for a view, and the tolerance is above the error of normalising in single
    // precision.
    return std::abs(glm::dot(v, v) - 1.0F) < 1e-3F;
}

bool isFiniteVector(const glm::vec3& v) {
    return !glm::any(glm::isnan(v)) && !glm::any(glm::isinf(v));
}

// The unit of the lengths that packed records keep as codes: see FrameConstants::lengthUnit. A pixel is about
// a thousandth of its distance wide, and a scene seldom extends over more than a million times the distance
// of the near plane. So the unit is a metre for near planes from 1/1024 m to 64 m. For others it is a power
// of two with which the codes can hold the narrowest cone at the near plane, or a scene that extends as far
// beyond it.
float lengthUnitOf(const CameraView& camera) {
    constexpr float kLeastNear = 0x1p-10F;
    constexpr float kMostNear = 0x1p6F;
    if (!(camera.near > 0.0F) || (camera.near >= kLeastNear && camera.near <= kMostNear)) {
        return 1.0F;
    }
    const float relative = camera.near / (camera.near < kLeastNear ? kLeastNear : kMostNear);
    // Beyond these bounds a unit, or its inverse, would leave the range of floats with the codes.
    return std::exp2(std::clamp(std::floor(std::log2(relative)), -80.0F, 80.0F));
}

// Returns the row of clip z, given the row of the distance along the view. z / w is 1 at the near plane and 0
// at the far one.
glm::vec4 depthRow(const CameraView& camera, const glm::vec4& distance) {
    const float range = camera.far - camera.near;
    const glm::vec4 one(0.0F, 0.0F, 0.0F, 1.0F);
    if (camera.orthographic) {
        return one * (camera.far / range) - distance / range;
    }
    if (camera.far == 0.0F) {
        return one * camera.near;
    }
    return one * (camera.near * camera.far / range) - distance * (camera.near / range);
}

}  // namespace

Status checkCamera(const CameraView& camera) {
    const char* hint = "see CameraView for what its members must be";
    const glm::vec3 forward = toVector(camera.forward);
    const glm::vec3 up = toVector(camera.up);
    const auto isPlace = [](double value) { return std::isfinite(value); };
    if (!std::ranges::all_of(camera.position, isPlace) || !isFiniteVector(forward) || !isFiniteVector(up) ||
        !std::isfinite(camera.halfWidth) || !std::isfinite(camera.halfHeight) ||
        !std::isfinite(camera.near) || !std::isfinite(camera.far)) {
        return makeError("camera", "", "the camera has a value that is not finite", hint);
    }
    if (!isUnit(forward) || !isUnit(up) || std::abs(glm::dot(forward, up)) > 1e-3F) {
        return makeError("camera", "", "the camera's forward and up are not unit and orthogonal", hint);
    }
    if (!(camera.halfWidth > 0.0F) || !(camera.halfHeight > 0.0F)) {
        return makeError("camera", "", "the camera's view has no extent", hint);
    }
    const bool infinite = !camera.orthographic && camera.far == 0.0F;
    const bool nearFits = camera.orthographic ? camera.near >= 0.0F : camera.near > 0.0F;
    if (!nearFits || (!infinite && !(camera.far > camera.near))) {
        return makeError("camera", "",
                         "the near plane at " + std::to_string(camera.near) + " and the far plane at " +
                             std::to_string(camera.far) + " make no range",
                         hint);
    }
    return okStatus();
}

namespace {

// Returns two numbers in [0, 1) that depend on a seed; both are 0 for the seed 0. It uses the finaliser of
// SplitMix64 (Steele, Lea and Flood 2014).
std::array<double, 2> shiftOf(std::uint32_t seed) {
    std::uint64_t bits = std::uint64_t{seed} * 0x9E3779B97F4A7C15ULL;
    bits = (bits ^ bits >> 30U) * 0xBF58476D1CE4E5B9ULL;
    bits = (bits ^ bits >> 27U) * 0x94D049BB133111EBULL;
    bits ^= bits >> 31U;
    return {static_cast<double>(bits >> 32U) * 0x1p-32, static_cast<double>(bits & 0xFFFFFFFFU) * 0x1p-32};
}

}  // namespace

gpu::vec2 sampleJitter(std::uint32_t sampleIndex, std::uint32_t seed) {
    // The constants are 1/g and 1/g², where g is the real root of x³ = x + 1.
    constexpr double kAlpha = 0.7548776662466927;
    constexpr double kBeta = 0.5698402909980532;
    // Rounding to float may give 0.5, which is outside the range.
    const std::array<double, 2> shift = shiftOf(seed);
    const auto offset = [&](double step, double start) {
        const double value = 0.5 + start + step * sampleIndex;
        const double fraction = value - std::floor(value) - 0.5;
        return std::min(static_cast<float>(fraction), std::nextafter(0.5F, 0.0F));
    };
    return {offset(kAlpha, shift[0]), offset(kBeta, shift[1])};
}

float sampleConeScale(std::uint32_t averagedSamples) {
    return 1.0F / std::sqrt(static_cast<float>(std::max(averagedSamples, 1U)));
}

void fillCamera(const CameraView& camera, const std::array<double, 3>& origin, std::uint32_t width,
                std::uint32_t height, gpu::vec2 jitter, gpu::FrameConstants& constants) {
    const glm::vec3 position(camera.position[0] - origin[0], camera.position[1] - origin[1],
                             camera.position[2] - origin[2]);
    const glm::vec3 forward = toVector(camera.forward);
    const glm::vec3 up = toVector(camera.up);
    const glm::vec3 right = glm::cross(forward, up);
    constants.cameraPosition = toRecord(position);
    constants.width = width;
    constants.cameraForward = toRecord(forward);
    constants.height = height;
    constants.cameraRight = toRecord(right * camera.halfWidth);
    constants.cameraUp = toRecord(up * camera.halfHeight);
    constants.orthographic = camera.orthographic ? 1 : 0;
    const float pixel = 2.0F * camera.halfHeight / static_cast<float>(height);
    constants.pixelSpread = camera.orthographic ? 0.0F : pixel;
    constants.pixelWidth = camera.orthographic ? pixel : 0.0F;
    constants.jitter = jitter;
    constants.lengthUnit = lengthUnitOf(camera);
    constants.perLengthUnit = 1.0F / constants.lengthUnit;

    const glm::vec4 distance = rowAlong(forward, position, 1.0F);
    const glm::vec4 w = camera.orthographic ? glm::vec4(0.0F, 0.0F, 0.0F, 1.0F) : distance;
    const glm::vec4 x = rowAlong(right, position, 1.0F / camera.halfWidth);
    const glm::vec4 y = rowAlong(up, position, -1.0F / camera.halfHeight);
    // The raster pass samples pixel centres, so the picture is shifted against the jitter.
    constants.worldToClip[0] = toRecord(x - w * (2.0F * jitter.x / static_cast<float>(width)));
    constants.worldToClip[1] = toRecord(y - w * (2.0F * jitter.y / static_cast<float>(height)));
    constants.worldToClip[2] = toRecord(depthRow(camera, distance));
    constants.worldToClip[3] = toRecord(w);
}

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
                         "create it with Environment::Options::sampled, or compile with --no-sky-light");
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
    constants.firstShadowCounts = frame.firstShadowCounts.address;
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

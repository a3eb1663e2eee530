#include "renderer/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace glint {
namespace {

using Float3 = std::array<float, 3>;

Float3 cross(const Float3& a, const Float3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

float dot(const Float3& a, const Float3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

gpu::vec3 scaled(const Float3& v, float factor) {
    return {v[0] * factor, v[1] * factor, v[2] * factor};
}

// Returns the row that takes a point to dot(axis, point - position) * factor.
gpu::vec4 rowAlong(const Float3& axis, const Float3& position, float factor) {
    return {axis[0] * factor, axis[1] * factor, axis[2] * factor, -dot(axis, position) * factor};
}

gpu::vec4 add(const gpu::vec4& a, const gpu::vec4& b, float factor) {
    return {a.x + b.x * factor, a.y + b.y * factor, a.z + b.z * factor, a.w + b.w * factor};
}

bool isUnit(const Float3& v) {
    // Four digits are enough for a view, and the tolerance is above what normalising in single precision
    // loses.
    return std::abs(dot(v, v) - 1.0F) < 1e-3F;
}

// Returns the row of clip z, given the row of the distance along the view. z / w is 1 at the near plane and 0
// at the far one.
gpu::vec4 depthRow(const CameraView& camera, const gpu::vec4& distance) {
    const float range = camera.far - camera.near;
    if (camera.orthographic) {
        return add({0.0F, 0.0F, 0.0F, camera.far / range}, distance, -1.0F / range);
    }
    if (camera.far == 0.0F) {
        return {0.0F, 0.0F, 0.0F, camera.near};
    }
    const gpu::vec4 constant{0.0F, 0.0F, 0.0F, camera.near * camera.far / range};
    return add(constant, distance, -camera.near / range);
}

}  // namespace

Status checkCamera(const CameraView& camera) {
    const auto finite = [](const Float3& v) {
        return std::ranges::all_of(v, [](float value) { return std::isfinite(value); });
    };
    const char* hint = "see CameraView for what its members must be";
    if (!finite(camera.position) || !finite(camera.forward) || !finite(camera.up) ||
        !std::isfinite(camera.halfWidth) || !std::isfinite(camera.halfHeight) ||
        !std::isfinite(camera.near) || !std::isfinite(camera.far)) {
        return makeError("camera", "", "the camera has a value that is not finite", hint);
    }
    if (!isUnit(camera.forward) || !isUnit(camera.up) || std::abs(dot(camera.forward, camera.up)) > 1e-3F) {
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

void fillCamera(const CameraView& camera, std::uint32_t width, std::uint32_t height, gpu::vec2 jitter,
                gpu::FrameConstants& constants) {
    const Float3 right = cross(camera.forward, camera.up);
    constants.cameraPosition = scaled(camera.position, 1.0F);
    constants.width = width;
    constants.cameraForward = scaled(camera.forward, 1.0F);
    constants.height = height;
    constants.cameraRight = scaled(right, camera.halfWidth);
    constants.cameraUp = scaled(camera.up, camera.halfHeight);
    constants.orthographic = camera.orthographic ? 1 : 0;
    const float pixel = 2.0F * camera.halfHeight / static_cast<float>(height);
    constants.pixelSpread = camera.orthographic ? 0.0F : pixel;
    constants.pixelWidth = camera.orthographic ? pixel : 0.0F;
    constants.jitter = jitter;

    const gpu::vec4 distance = rowAlong(camera.forward, camera.position, 1.0F);
    const gpu::vec4 one{0.0F, 0.0F, 0.0F, 1.0F};
    const gpu::vec4 w = camera.orthographic ? one : distance;
    const gpu::vec4 x = rowAlong(right, camera.position, 1.0F / camera.halfWidth);
    const gpu::vec4 y = rowAlong(camera.up, camera.position, -1.0F / camera.halfHeight);
    // The raster pass samples pixel centres, so the picture is shifted against the jitter.
    constants.worldToClip[0] = add(x, w, -2.0F * jitter.x / static_cast<float>(width));
    constants.worldToClip[1] = add(y, w, -2.0F * jitter.y / static_cast<float>(height));
    constants.worldToClip[2] = depthRow(camera, distance);
    constants.worldToClip[3] = w;
}

}  // namespace glint

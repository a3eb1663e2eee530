// Equirectangular maps of radiance on the host: directions, solid angles, sizes.
#pragma once

#include <glint/image.h>
#include <glint/result.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace glint {

using Radiance = std::array<float, 3>;

// A map whose radiance is constant within a texel. Row 0 is up. A point (u, v) of [0, 1]² has the polar angle
// πv from +Y and the azimuth 2π(u - 1/2) from +X towards +Z.
struct RadianceMap {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<Radiance> texels;
};

struct CheckedMap {
    RadianceMap map;
    std::uint64_t negativePixels = 0;  // pixels with a channel below 0, which is 0 now
};

// The largest radiance that is accepted. Its sums over lobes and lights stay far below the largest 32-bit
// float.
inline constexpr float kMaxRadiance = 1e18F;

// Errors "environment-size" and "environment-radiance", as in Environment::create().
Result<CheckedMap> checkMap(const LinearImage& image);

// Returns a map of another size with the same light. Each texel is the mean, by solid angle, of the area that
// it covers.
RadianceMap resample(const RadianceMap& map, std::uint32_t width, std::uint32_t height);

// Returns the cosine of the polar angle at the upper edge of a row. For row = height it is that of the lower
// edge of the map.
double cosineAbove(std::uint32_t row, std::uint32_t height);

// Returns the solid angle of each texel of a row, in steradians. Over all texels these angles add up to 4π.
double texelSolidAngle(std::uint32_t row, std::uint32_t width, std::uint32_t height);

// The weights of ITU-R BT.709.
inline float luminance(const Radiance& radiance) {
    return 0.2126F * radiance[0] + 0.7152F * radiance[1] + 0.0722F * radiance[2];
}

}  // namespace glint

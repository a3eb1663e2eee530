// Equirectangular maps of radiance on the host: directions, solid angles, sizes.
#pragma once

#include <glint/renderer.h>
#include <glint/result.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace glint {

using Radiance = std::array<float, 3>;

// Constant within a texel. Row 0 is up: a point (u, v) of [0, 1]² has the polar angle πv from +Y and the
// azimuth 2π(u - 1/2) from +X towards +Z.
struct RadianceMap {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<Radiance> texels;
};

struct CheckedMap {
    RadianceMap map;
    std::uint64_t negativePixels = 0;  // some of their channels were below 0 and are 0 now
};

// Largest radiance that is taken: sums of it over lobes and lights stay far from the end of 32-bit floats.
inline constexpr float kMaxRadiance = 1e18F;

// Errors "environment-size", "environment-radiance" as of Environment::create().
Result<CheckedMap> checkMap(const LinearImage& image);

// The same light in another size: each texel is the mean, by solid angle, of what it covers.
RadianceMap resample(const RadianceMap& map, std::uint32_t width, std::uint32_t height);

// cos of the polar angle at the upper edge of a row; row = height: of the lower edge of the map.
double cosineAbove(std::uint32_t row, std::uint32_t height);

// Solid angle of each texel of a row, steradians; over all texels they add up to 4π.
double texelSolidAngle(std::uint32_t row, std::uint32_t width, std::uint32_t height);

// ITU-R BT.709.
inline float luminance(const Radiance& radiance) {
    return 0.2126F * radiance[0] + 0.7152F * radiance[1] + 0.0722F * radiance[2];
}

}  // namespace glint

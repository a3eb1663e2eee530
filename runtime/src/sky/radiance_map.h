// Equirectangular maps of radiance on the host: directions, solid angles, sizes, their diffuse light, and the
// distribution by which surfaces sample them.
#pragma once

#include <glint/image.h>
#include <glint/result.h>

#include <array>
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

// --- The diffuse light of a map in real spherical harmonics ---

// The irradiance over π of a surface with the normal (x, y, z), as a polynomial. It has coefficients of 1, x,
// y, z, 3y² - 1, xy, yz, xz, x² - z², each for red, green and blue.
using SkyHarmonics = std::array<std::array<double, 3>, 9>;

// Returns orders 0 to 2 with the cosine lobe folded in (Ramamoorthi and Hanrahan 2001, "An Efficient
// Representation for Irradiance Environment Maps"). The integrals over each texel are exact.
SkyHarmonics skyHarmonics(const RadianceMap& map);

// Returns the harmonics of the map turned about +Y by `angle` radians, counter-clockwise as seen from above.
SkyHarmonics turned(const SkyHarmonics& harmonics, double angle);

// --- The distribution by which surfaces sample an environment map as a light (shaders/host/sky.glsl) ---

// The largest size in cells.
inline constexpr std::uint32_t kMostSkyColumns = 1024;
inline constexpr std::uint32_t kMostSkyRows = 512;

// A distribution that is constant in each cell (pbrt-v4, PiecewiseConstant2D). Cells divide azimuth and polar
// angle evenly. A row is chosen first, then a column of it. `counts` holds running sums: of the rows, then
// for each row of its columns. Each of these lists ends with gpu::kSkyCounts, and each cell has a count of at
// least 1. A random number of 24 bits falls on a cell with a probability of exactly count / kSkyCounts, so
// the density that shaders compute from the counts is that of their samples, however bright a cell is.
struct SkyCounts {
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    std::vector<std::uint32_t> counts;  // rows * (1 + columns)
};

// Returns the distribution of a map that fits the device. The weight of a cell is the integral of the
// luminance that bilinear lookups see, and one hundredth of its mean over the sphere, so that other
// directions than those of a small sun stay likely. A black map has a uniform distribution.
SkyCounts skyCounts(const RadianceMap& map);

// --- Conversion to 16-bit floats ---

inline constexpr float kMaxHalf = 65504.0F;

// Converts to IEC 60559 binary16, rounded to the nearest, ties to even. Requires 0 <= value <= kMaxHalf.
std::uint16_t toHalf(float value);

}  // namespace glint

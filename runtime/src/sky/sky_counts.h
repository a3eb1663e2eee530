// The distribution by which surfaces sample an environment map as a light (shaders/host/sky.glsl).
#pragma once

#include "sky/radiance_map.h"

#include <cstdint>
#include <vector>

namespace glint {

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

}  // namespace glint

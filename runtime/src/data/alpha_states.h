// Proves which triangles, and which parts of them, an alpha test lets no ray or every ray through. The proof
// is by intervals over all texels that a lookup can reach; it takes no samples.
//
// The proof is about the alpha test of hit/alpha.glsl: alpha = factor * texture(uv).a * vertex alpha, in 32
// bits, at mip 0. The surface is there where alpha >= cutoff.
#pragma once

#include "data/opacity_micromap.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace glint::opacity {

// The errors that a device's arithmetic may have. All bounds are widened by it.
struct ErrorModel {
    // The error of a coordinate in texels. Vulkan asks for at least 4 bits below a texel
    // (subTexelPrecisionBits).
    double texelPosition = 1.0 / 16.0;
    // The error of a coordinate before it is scaled to texels, relative to the largest number that it is
    // computed from.
    double coordinate = 32.0 * 0x1p-24;
    // The distance by which barycentrics may lie outside of their triangle.
    double outside = 0x1p-20;
    // The distance, in barycentrics, between the point that is tested and the one that chose the
    // micro-triangle.
    double microTriangle = 0x1p-14;
    // The error of a filtered value, beyond the least and the greatest texel. Nearest texels are exact but
    // for `conversionUlps`.
    double filter = 0x1p-9;
    // The error of the conversion of a texel to a float, in units in the last place. 0 and 1 are exact.
    int conversionUlps = 1;
    // The error of each product, in units in the last place. A product with 0 or 1 is exact.
    int productUlps = 1;
    // The error of vertex alpha, relative to the largest of the three.
    double vertexAlpha = 0x1p-20;
    // The error of a texel, in steps of its 8 bits: for images that a device decodes or narrows by itself.
    int texelSteps = 0;
};

enum class Wrap : std::uint32_t { Repeat = 0, Clamp = 1, Mirror = 2 };  // SamplerEntry::wrapU

// The alpha of an image's first level.
struct AlphaTexels {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> alpha;  // row by row, 255 is 1
};

// A texture as an alpha test reads it. `texels` must outlive it.
struct AlphaLookup {
    const AlphaTexels* texels = nullptr;
    Wrap wrapU = Wrap::Repeat;
    Wrap wrapV = Wrap::Repeat;
    bool linear = true;  // one of the sampler's filters is linear
    // The coordinates that are looked up are dot(rowU, (u, v, 1)) and dot(rowV, (u, v, 1)).
    std::array<float, 3> rowU{1, 0, 0};
    std::array<float, 3> rowV{0, 1, 0};
};

struct AlphaMaterial {
    float factor = 1.0F;
    float cutoff = 0.5F;
    std::optional<AlphaLookup> lookup;
};

struct AlphaTriangle {
    std::array<std::array<float, 2>, 3> uv{};              // as the shader reads them
    std::optional<std::array<float, 3>> vertexAlpha = {};  // none: 1
};

// Bounds of the alpha that the shader compares. Both are rounded outwards.
struct AlphaBounds {
    float least = 0.0F;
    float most = 0.0F;
};
// The texture's value is within [leastTexel, mostTexel], in steps of 255; vertex alpha is in `vertex`.
AlphaBounds boundsOf(const AlphaMaterial& material, std::uint32_t leastTexel, std::uint32_t mostTexel,
                     const AlphaBounds& vertex, const ErrorModel& model);

// Returns the state of a whole triangle; unknown if it has both or if nothing can be proved. Numbers that are
// not finite prove nothing.
State stateOf(const AlphaMaterial& material, const AlphaTriangle& triangle, const ErrorModel& model = {});

// Returns the states of a triangle's micro-triangles, at the least level whose micro-triangles are about
// `texels` long, or at `maxLevel`. Unknown ones lean to the alpha of their middle.
TriangleStates statesOf(const AlphaMaterial& material, const AlphaTriangle& triangle, std::uint32_t maxLevel,
                        double texels = 2.0, const ErrorModel& model = {});

}  // namespace glint::opacity

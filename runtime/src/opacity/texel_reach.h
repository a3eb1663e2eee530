// The texels that lookups within a triangle can reach.
#pragma once

#include <glint/alpha_states.h>

#include <array>
#include <cstdint>

namespace glint::opacity {

// A triangle in texels of an image: texel t covers [t, t + 1].
struct TexelTriangle {
    std::array<double, 3> x{};
    std::array<double, 3> y{};
    // The error that a lookup's coordinates may have.
    double marginX = 0.0;
    double marginY = 0.0;
};

struct TexelRange {
    std::uint32_t least = 255;
    std::uint32_t most = 0;
};

// Walks over every texel that a lookup in the triangle can read: row by row of texels, in each row between
// the ends of the part of the triangle whose lookups reach the row. The walk is exact: it visits only texels
// that some point of the triangle reaches when it is moved by at most the margins.
class TexelWalk {
public:
    // Requires finite numbers. Keeps references.
    TexelWalk(const AlphaLookup& lookup, const TexelTriangle& triangle);

    // Extends `range` by the next row. Returns false if there was none.
    bool next(TexelRange& range);

private:
    void extendAll(TexelRange& range) const;
    void extendRow(std::int64_t row, std::int64_t first, std::int64_t last, TexelRange& range) const;

    const AlphaLookup& lookup_;
    const TexelTriangle& triangle_;
    double below_;  // a lookup at x reaches texels from x - below on
    double above_;  // and up to x + above
    bool whole_ = false;
    std::int64_t row_ = 0;
    std::int64_t lastRow_ = -1;
};

// Returns the texel in [0, size) that a wrap mode reads for any texel.
std::uint32_t wrapped(std::int64_t texel, std::uint32_t size, Wrap wrap);

}  // namespace glint::opacity

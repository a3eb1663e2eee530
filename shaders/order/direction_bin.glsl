// Bins of directions.
#include "hit/geometry.glsl"
#include "interop/frame.h"

// Returns the bin of a unit vector by kBinning*. It is below kMaxDirectionBins, even for invalid numbers.
uint directionBin(vec3 direction, uint binning) {
    if (binning == kBinningNone) {
        return 0u;
    }
    if (binning == kBinningSign) {
        return (direction.x < 0.0 ? 1u : 0u) | (direction.y < 0.0 ? 2u : 0u) | (direction.z < 0.0 ? 4u : 0u);
    }
    // There are 8 x 8 cells. The far edges of the map belong to the last cells.
    vec2 cell = clamp(octahedralEncode(direction) * 4.0 + 4.0, vec2(0.0), vec2(7.0));
    return min(uint(cell.x) + 8u * uint(cell.y), kMaxDirectionBins - 1u);
}

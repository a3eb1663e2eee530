// A device's alpha test in floats, with the worst arithmetic that ErrorModel allows, and a search for
// micro-triangles whose state it contradicts. It shares no code with what it checks.
#pragma once

#include "data/alpha_states.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

inline bool operator==(const VkMicromapTriangleEXT& a, const VkMicromapTriangleEXT& b) {
    return a.dataOffset == b.dataOffset && a.subdivisionLevel == b.subdivisionLevel && a.format == b.format;
}
inline bool operator==(const VkMicromapUsageEXT& a, const VkMicromapUsageEXT& b) {
    return a.count == b.count && a.subdivisionLevel == b.subdivisionLevel && a.format == b.format;
}

namespace glint::test {

// An alpha test of some triangles. `texels` is what `material.lookup` refers to.
struct AlphaCase {
    std::string name;
    opacity::AlphaTexels texels;
    opacity::AlphaMaterial material;
    std::vector<opacity::AlphaTriangle> triangles;
};
// Makes a case out of a number: sizes, filters, wraps, transforms, cutoffs that equal texels or bounds,
// seams, triangles without area, mirrored ones, and coordinates and factors that are far off or no numbers.
AlphaCase makeAlphaCase(std::uint64_t number);

struct Contradiction {
    std::size_t triangle = 0;
    std::uint32_t place = 0;  // on the curve of `level`
    std::uint32_t level = 0;
    float alpha = 0.0F;
};

struct CheckedStates {
    std::uint64_t microTriangles = 0;
    std::uint64_t known = 0;
    std::uint64_t opaque = 0;
    // Unknown ones where the device's best arithmetic found the same answer at every point.
    std::uint64_t needless = 0;
    std::vector<Contradiction> wrong;
};

// Evaluates the alpha test at points of each micro-triangle of each triangle: its corners, the middles of its
// edges, points within and points just outside, each with coordinates that are off by as much as the model
// allows in eight directions and not at all, and with values that lean against the state.
void checkStates(const AlphaCase& given, const opacity::MicromapArray& array,
                 const opacity::ErrorModel& model, CheckedStates& checked);

// The alpha of a point. The coordinates are off by (dx, dy) texels, and the values lean down (-1), up (1) or
// not at all (0) as far as the model allows.
float alphaAt(const AlphaCase& given, const opacity::AlphaTriangle& triangle, float u, float v, double dx,
              double dy, int lean, const opacity::ErrorModel& model);

// --- Reads micromaps as devices do ---

// Returns the micro-triangle that has the point with these barycentrics (weights of corners 1 and 2).
opacity::MicroTriangle microTriangleAt(float u, float v, std::uint32_t level);

// Returns a state of a triangle. `place` is that on the curve of `level`, which must not be below the level
// of the triangle's record; a coarser record's state holds for all micro-triangles within. Requires an array
// that faultIn() finds no fault in.
opacity::State stateAt(const opacity::MicromapArray& array, std::size_t triangle, std::uint32_t place,
                       std::uint32_t level);

// Returns the fault of an array, as a phrase, or no value: records outside of the data, overlapping ones,
// levels above `maxLevel`, unknown formats, indices without a record, usages that do not count the records.
std::optional<const char*> faultIn(const opacity::MicromapArray& array, std::uint32_t maxLevel);

}  // namespace glint::test

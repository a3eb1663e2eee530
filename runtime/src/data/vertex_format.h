// The compact forms of positions and of other attributes of vertices.
#pragma once

#include <glint/scene_view.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace glint {

// All primitives of a mesh have one grid, so that positions that are equal stay equal and no seam between
// primitives opens. A coordinate is least + step * code, with codes of 0 to 65535; the product and the sum
// are rounded to floats, one after the other, as shaders/host/geometry.glsl does.
struct PositionGrid {
    std::array<float, 3> least{};
    std::array<float, 3> step{};
};

// A primitive's positions in 16 bits.
struct GridPositions {
    // For the device: the bits of least and step, then three codes of 16 bits for each vertex. It is empty if
    // the positions are stored in full.
    std::vector<std::uint32_t> words;
    // The values that the words stand for, bit-exact.
    std::vector<std::array<float, 3>> values;
};

// Returns a grid on which every position lies, up to a rounding error of 2^-22 of the mesh's largest
// coordinate on an axis: coordinates that a file has as integers of 8 or 16 bits, and others that are
// multiples of a power of two. There is no value if no such grid exists.
std::optional<PositionGrid> findGrid(std::span<const PrimitiveView> mesh);

// Returns a grid over the box of the mesh, on which a coordinate moves by at most half a step: 1/131070 of
// the box. An axis that findGrid() can keep is kept. There is no grid if a coordinate is not finite.
std::optional<PositionGrid> coverByGrid(std::span<const PrimitiveView> mesh);

GridPositions placeOnGrid(std::span<const std::array<float, 3>> positions, const PositionGrid& grid);

// Returns the positions of each primitive in the form that the scene asks for. Those of meshes that follow
// joints or morph targets stay as they are, because the device computes with them. `primitives` are sorted by
// mesh.
std::vector<GridPositions> packPositions(std::span<const PrimitiveView> primitives,
                                         SceneView::VertexForm form);

// Returns the primitives with the values of `positions`, which must outlive the result, in place of their own
// positions.
std::vector<PrimitiveView> withPositions(std::span<const PrimitiveView> primitives,
                                         std::span<const GridPositions> positions);

// The compact forms of a vertex's attributes, as shaders/host/geometry.glsl reads them. All are 4 or 8 bytes.

// Each function returns words for the device, or none if the values would lose more than their bound allows.
// Pure.

// Octahedral, 2 x 16 bits, snorm, the nearest of the neighbouring codes: within 4.4e-5 rad. None if a
// vector's length is not within 1e-3 of 1.
std::optional<std::vector<std::uint32_t>> packNormals(std::span<const std::array<float, 3>> normals);

// Octahedral, 16 and 15 bits, and the sign of w: within 7.5e-5 rad. None if a vector is no unit vector, or w
// is not ±1.
std::optional<std::vector<std::uint32_t>> packTangents(std::span<const std::array<float, 4>> tangents);

// Two coordinates of 16 bits between the least and the largest of the primitive. The first four words are the
// bits of floats: the least u and v, and the step of each. Coordinates that a file has in 16 bits of [0, 1]
// keep their values. None if a step is above 2^-14, as where a texture is repeated many times, or is not
// finite.
std::optional<std::vector<std::uint32_t>> packTexCoords(std::span<const std::array<float, 2>> texCoords);

// Linear RGBA.
struct PackedColors {
    std::uint32_t bits = 0;  // of a channel: 8 if the colours are numbers of 8 bits, else 16
    std::vector<std::uint32_t> words;
};
// None if a channel is outside of [0, 1].
std::optional<PackedColors> packColors(std::span<const std::array<float, 4>> colors);

}  // namespace glint

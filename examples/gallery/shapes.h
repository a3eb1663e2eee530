// Shapes with normals, tangents and both sets of texture coordinates, centred on the origin unless said
// otherwise. Sizes in metres.
#pragma once

#include "mesh.h"

#include <functional>
#include <span>

namespace gallery {

struct SurfacePoint {
    glm::vec3 position{};
    glm::vec3 normal{0.0F, 1.0F, 0.0F};  // unit, outward
};

// A surface over [0, 1]²; seen from outside, u runs to the right and v down.
using Surface = std::function<SurfacePoint(float u, float v)>;

// Samples a surface at (columns + 1) x (rows + 1) points. Both texture coordinate sets are (u, v).
MeshData grid(int columns, int rows, const Surface& surface);

MeshData sphere(float radius, int columns, int rows);

// Axis +Y.
MeshData torus(float majorRadius, float minorRadius, int columns, int rows);

// The (p, q) torus knot about +Y: p turns around the axis, q through the hole.
MeshData torusKnot(int p, int q, float majorRadius, float knotRadius, float tubeRadius, int columns,
                   int rows);

// Turns a profile of (radius, height) points, listed from top to bottom, about +Y.
// `smooth` runs a Catmull-Rom spline through the points; else each segment is a cone of its own.
MeshData lathe(std::span<const glm::vec2> profile, bool smooth, int columns, int rowsPerSegment);

// Six faces; TEXCOORD_0 in metres, TEXCOORD_1 spans [0, 1]² on each face.
MeshData box(const glm::vec3& size);

// A box with edges rounded by `radius`, `segments` steps to an edge. TEXCOORD_0 in metres.
MeshData roundedBox(const glm::vec3& size, float radius, int segments);

// A rectangle in the XY plane that faces +Z. TEXCOORD_0 in metres, TEXCOORD_1 over [0, 1]².
MeshData panel(const glm::vec2& size);

// A wall in the XY plane, both faces, with a round hole. The origin is the middle of its foot.
// TEXCOORD_0 in metres. `holeCentre` is in the wall's plane.
MeshData gateWall(const glm::vec3& size, const glm::vec2& holeCentre, float holeRadius);

// A brilliant of `sides` sides about +Y. Positions only: its facets are meant to be shaded flat.
MeshData gem(float radius, int sides);

// A rosette of `count` bent, pointed leaves that grow from the origin. Single-sided sheets.
MeshData rosette(int count, float length);

}  // namespace gallery

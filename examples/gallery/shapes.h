// Shapes with normals, tangents and both sets of texture coordinates. They are centred on the origin unless a
// comment says otherwise. Sizes are in metres.
#pragma once

#include "mesh.h"

#include <functional>
#include <span>

namespace gallery {

struct SurfacePoint {
    glm::vec3 position{};
    glm::vec3 normal{0.0F, 1.0F, 0.0F};  // unit, outward
};

// A surface over [0, 1]². Seen from outside, u runs to the right and v down.
using Surface = std::function<SurfacePoint(float u, float v)>;

// Samples a surface at (columns + 1) x (rows + 1) points. Both texture coordinate sets are (u, v).
MeshData grid(int columns, int rows, const Surface& surface);

MeshData sphere(float radius, int columns, int rows);

// A torus about +Y.
MeshData torus(float majorRadius, float minorRadius, int columns, int rows);

// The (p, q) torus knot about +Y: p counts turns around the axis, q turns through the hole.
MeshData torusKnot(int p, int q, float majorRadius, float knotRadius, float tubeRadius, int columns,
                   int rows);

// Turns a profile of (radius, height) points, listed from top to bottom, about +Y. `smooth` puts a
// Catmull-Rom spline through the points; otherwise each segment is a separate cone.
MeshData lathe(std::span<const glm::vec2> profile, bool smooth, int columns, int rowsPerSegment);

// A box of six faces. TEXCOORD_0 is in metres, TEXCOORD_1 spans [0, 1]² on each face.
MeshData box(const glm::vec3& size);

// A box whose edges are rounded by `radius`, in `segments` steps for each edge. TEXCOORD_0 is in metres.
MeshData roundedBox(const glm::vec3& size, float radius, int segments);

// A rectangle in the XY plane that faces +Z. TEXCOORD_0 is in metres, TEXCOORD_1 spans [0, 1]².
MeshData panel(const glm::vec2& size);

// A wall in the XY plane with two faces and a round hole. The origin is the middle of its foot. TEXCOORD_0 is
// in metres. `holeCentre` is in the wall's plane.
MeshData gateWall(const glm::vec3& size, const glm::vec2& holeCentre, float holeRadius);

// A brilliant with `sides` sides about +Y. It has positions only, because its facets are meant to be shaded
// flat.
MeshData gem(float radius, int sides);

// A rosette of `count` bent, pointed leaves that grow from the origin. They are single-sided sheets.
MeshData rosette(int count, float length);

}  // namespace gallery

// 4 x 4 transforms in double precision, column-major as in glTF.
#pragma once

#include "base/vectors.h"
#include "gltf/scene.h"

#include <array>
#include <optional>
#include <vector>

namespace glint::gltf {

inline Matrix4 identity() {
    return base::toArray(glm::dmat4(1.0));
}
inline Matrix4 multiply(const Matrix4& a, const Matrix4& b) {
    return base::toArray(base::toMatrix(a) * base::toMatrix(b));
}
// Returns T * R * S.
Matrix4 compose(const Transform& transform);
// Returns the transform of one placement of a mesh relative to its node. `index` is less than the count.
Matrix4 instanceTransform(const Instancing& instancing, std::size_t index);
// Returns the world transforms at which the node draws its mesh, one for each placement. There are none if
// the node has no mesh or is not shown.
std::vector<Matrix4> placesOf(const Scene& scene, const Node& node);
// Makes the last row 0 0 0 1. Returns whether it was.
bool clearProjection(Matrix4& matrix);
// Returns whether every element fits into a float.
bool fitsFloat(const Matrix4& matrix);

// Returns nothing if the vector is shorter than the least normal float or not finite.
std::optional<glm::dvec3> normalized(const glm::dvec3& v);

// Returns the transform's position and directions without scale, shear or mirroring. Z stays, Y is turned to
// a right angle with it, and X follows. Returns nothing if Y and Z don't span a plane.
std::optional<Matrix4> rigidPart(const Matrix4& matrix);

}  // namespace glint::gltf

// 4 x 4 transforms in double precision, column-major as in glTF.
#pragma once

#include "base/vectors.h"
#include "gltf/scene.h"

#include <array>
#include <optional>
#include <vector>

namespace glint::gltf {

Matrix4 identity();
Matrix4 multiply(const Matrix4& a, const Matrix4& b);
// T * R * S; `rotation` is a unit quaternion (x, y, z, w).
Matrix4 compose(const Double3& translation, const std::array<double, 4>& rotation, const Double3& scale);
// Of a mesh's placement below its node; `index` is less than the count.
Matrix4 instanceTransform(const Instancing& instancing, std::size_t index);
// In the world: where the node draws its mesh, once for each placement; nowhere if it has none, or is not
// shown.
std::vector<Matrix4> placesOf(const Scene& scene, const Node& node);
// Whether every element fits into a float.
bool fitsFloat(const Matrix4& matrix);

// Nothing where the vector is shorter than the least normal float, or not finite.
std::optional<Double3> normalized(const Double3& v);

// The transform's position and directions, without scale, shear or mirroring: Z stays, Y is turned to a right
// angle with it, X follows. Nothing where Y and Z don't span a plane.
std::optional<Matrix4> rigidPart(const Matrix4& matrix);

}  // namespace glint::gltf

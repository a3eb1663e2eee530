// Makes the attributes of a primitive finite, and gives them unit length where glTF requires it.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

namespace glint::gltf {

// Drops triangles that use a position that is not finite, and moves such positions to the origin. Normalises
// normals and tangents. A normal that is zero or not finite becomes the geometric normal of a triangle around
// it, or +Z if there is none; such a tangent becomes any direction in the surface. Texture coordinates that
// are not finite become 0, and such colours become 1. Warns once about each kind and states the count.
void repairPrimitive(Document& document, Primitive& primitive);

}  // namespace glint::gltf

// Makes the attributes of a primitive finite and unit where they have to be.
#pragma once

#include "gltf/document.h"
#include "gltf/scene.h"

namespace glint::gltf {

// Drops triangles that use a position that is not finite, and moves such positions to the origin. Normalises
// normals and tangents; one that is zero or not finite becomes the geometric normal of a triangle around it
// (else +Z), or any direction in the surface. Texture coordinates that are not finite become 0, colours 1.
// Warns once of each kind, with the count.
void repairPrimitive(Document& document, Primitive& primitive);

}  // namespace glint::gltf

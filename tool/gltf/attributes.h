// Reads vertex attributes and the vertex order of one primitive, from accessors or from Draco data.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <cstdint>
#include <vector>

namespace glint::gltf {

// One primitive while it is imported.
struct PrimitiveSource {
    Document& document;
    const tinygltf::Primitive& file;
};

// Fills the attribute arrays of `primitive`, whose pointer is set. The values are those of the file, before
// repairs. Returns the order in which the primitive's mode uses the vertices; each index is below the number
// of positions. Sets `isList` if that order is a triangle list whatever the mode is. Requires POSITION.
Result<std::vector<std::uint32_t>> readVertices(const PrimitiveSource& source, Primitive& primitive,
                                                bool& isList);

}  // namespace glint::gltf

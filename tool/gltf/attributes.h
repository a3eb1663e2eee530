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
    const Json& json;
};

// Returns how the primitive uses its vertices, as glTF's number. 4, a list of triangles, is the default.
int modeOf(const PrimitiveSource& source);

// Returns the accessor of the attribute with that name, or -1 if the primitive has no such attribute. The
// name is one of kAttributes or of the model's attributes, as only their accessors have been checked.
int attributeAccessor(const PrimitiveSource& source, const char* attribute);

// Fills the attribute arrays of `primitive`, whose pointer is set. The values are those of the file, before
// repairs. Returns the order in which the primitive's mode uses the vertices; each index is below the number
// of positions. Sets `isList` if that order is a triangle list whatever the mode is. Requires POSITION.
Result<std::vector<std::uint32_t>> readVertices(const PrimitiveSource& source, Primitive& primitive,
                                                bool& isList);

}  // namespace glint::gltf

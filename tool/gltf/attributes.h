// Vertex attributes and vertex order of one primitive, from accessors or from Draco data.
#pragma once

#include "gltf/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <cstdint>
#include <vector>

namespace glint::gltf {

// One primitive on its way from the file to the scene.
struct PrimitiveSource {
    Document& document;
    const tinygltf::Primitive& model;
    const Json& json;  // the same primitive
};

// The accessor of the attribute of that name; -1 where the primitive lacks it.
int attributeAccessor(const PrimitiveSource& source, const char* attribute);

// Fills the attribute arrays of `primitive`, whose pointer is set, as the file has them: not yet repaired.
// Returns the order in which the primitive's mode takes the vertices, each index below the count of
// positions. `isList` is set where that order is a triangle list whatever the mode says. Requires POSITION.
Result<std::vector<std::uint32_t>> readVertices(const PrimitiveSource& source, Primitive& primitive,
                                                bool& isList);

}  // namespace glint::gltf

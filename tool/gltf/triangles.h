// Turns primitive modes into triangle lists.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glint::gltf {

// The numbers are those of glTF.
enum class PrimitiveMode : std::uint8_t {
    Points = 0,
    Lines = 1,
    LineLoop = 2,
    LineStrip = 3,
    Triangles = 4,
    TriangleStrip = 5,
    TriangleFan = 6
};

struct TriangleList {
    std::vector<std::uint32_t> indices;  // 3 for each triangle
    std::size_t leftOver = 0;            // number of indices at the end that form no triangle
};

// The mode must be one of triangles. The winding is kept, so every second triangle of a strip is turned.
TriangleList makeTriangles(PrimitiveMode mode, std::vector<std::uint32_t> indices);

}  // namespace glint::gltf

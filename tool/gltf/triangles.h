// Primitive modes into triangle lists.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glint::gltf {

// glTF's numbers.
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
    std::vector<std::uint32_t> indices;  // 3 a triangle
    std::size_t leftOver = 0;            // indices at the end that make no triangle
};

// Requires a triangle mode. Keeps the winding: of a strip, every second triangle is turned.
TriangleList makeTriangles(PrimitiveMode mode, std::vector<std::uint32_t> indices);

}  // namespace glint::gltf

#include "gltf/triangles.h"

#include <utility>

namespace glint::gltf {

TriangleList makeTriangles(PrimitiveMode mode, std::vector<std::uint32_t> indices) {
    if (mode == PrimitiveMode::Triangles) {
        const std::size_t leftOver = indices.size() % 3;
        indices.resize(indices.size() - leftOver);
        return {std::move(indices), leftOver};
    }
    if (indices.size() < 3) {
        return {{}, indices.size()};
    }
    TriangleList list;
    list.indices.reserve((indices.size() - 2) * 3);
    for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
        // The specification orders the vertices in this way (glTF 2.0, section 3.7.2.1).
        const std::size_t odd = i % 2;
        if (mode == PrimitiveMode::TriangleStrip) {
            list.indices.insert(list.indices.end(), {indices[i], indices[i + 1 + odd], indices[i + 2 - odd]});
        } else {
            list.indices.insert(list.indices.end(), {indices[i + 1], indices[i + 2], indices[0]});
        }
    }
    return list;
}

}  // namespace glint::gltf

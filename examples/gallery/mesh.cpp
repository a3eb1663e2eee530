#include "mesh.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace gallery {

void append(MeshData& mesh, const MeshData& part, const glm::mat4& transform) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    const glm::mat3 linear(transform);
    for (const glm::vec3& position : part.positions) {
        mesh.positions.emplace_back(transform * glm::vec4(position, 1.0F));
    }
    for (const glm::vec3& normal : part.normals) {
        mesh.normals.push_back(glm::normalize(linear * normal));
    }
    for (const glm::vec4& tangent : part.tangents) {
        mesh.tangents.emplace_back(glm::normalize(linear * glm::vec3(tangent)), tangent.w);
    }
    mesh.texCoords0.insert(mesh.texCoords0.end(), part.texCoords0.begin(), part.texCoords0.end());
    mesh.texCoords1.insert(mesh.texCoords1.end(), part.texCoords1.begin(), part.texCoords1.end());
    mesh.colors.insert(mesh.colors.end(), part.colors.begin(), part.colors.end());
    for (const std::uint32_t index : part.indices) {
        mesh.indices.push_back(base + index);
    }
}

void scaleTexCoords(MeshData& mesh, const glm::vec2& scale) {
    for (glm::vec2& texCoord : mesh.texCoords0) {
        texCoord *= scale;
    }
}

void paintVertices(MeshData& mesh, const std::function<glm::vec4(const glm::vec3&)>& colorOf) {
    mesh.colors.clear();
    for (const glm::vec3& position : mesh.positions) {
        mesh.colors.push_back(colorOf(position));
    }
}

}  // namespace gallery

// Triangle meshes as plain arrays, and the few operations that building a scene needs.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace gallery {

// Every attribute is empty or as long as positions. Units are metres, +Y is up, and fronts are
// counter-clockwise. Texture coordinates have V down; the bitangent is cross(normal, tangent) * w and points
// up in the image.
struct MeshData {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec4> tangents;
    std::vector<glm::vec2> texCoords0;
    std::vector<glm::vec2> texCoords1;  // within [0, 1]
    std::vector<glm::vec4> colors;      // linear RGBA within [0, 1]
    std::vector<std::uint32_t> indices;
};

// Appends `part`, transformed by `transform`: rotation, translation and uniform positive scale. Both meshes
// must have the same attributes, unless `mesh` has none at all.
void append(MeshData& mesh, const MeshData& part, const glm::mat4& transform = glm::mat4(1.0F));

void scaleTexCoords(MeshData& mesh, const glm::vec2& scale);

// Fills the vertex colours from a function of the position.
void paintVertices(MeshData& mesh, const std::function<glm::vec4(const glm::vec3&)>& colorOf);

}  // namespace gallery

// Tests shapes: they are closed and outward, and tangents follow the texture coordinates.
#include "shapes.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

namespace gallery::test {

namespace {

// By the divergence theorem this is positive for a closed surface with outward, counter-clockwise faces.
float enclosedVolume(const MeshData& mesh) {
    double volume = 0.0;
    for (std::size_t at = 0; at < mesh.indices.size(); at += 3) {
        const glm::vec3 a = mesh.positions[mesh.indices[at]];
        const glm::vec3 b = mesh.positions[mesh.indices[at + 1]];
        const glm::vec3 c = mesh.positions[mesh.indices[at + 2]];
        volume += static_cast<double>(glm::dot(a, glm::cross(b, c))) / 6.0;
    }
    return static_cast<float>(volume);
}

// Expects that every face is on the side of its vertices' normals, and that the frame follows the
// coordinates.
void expectConsistentFrames(const MeshData& mesh, const std::string& name) {
    for (std::size_t at = 0; at < mesh.indices.size(); at += 3) {
        const std::array<std::uint32_t, 3> corner{mesh.indices[at], mesh.indices[at + 1],
                                                  mesh.indices[at + 2]};
        const glm::vec3 edge1 = mesh.positions[corner[1]] - mesh.positions[corner[0]];
        const glm::vec3 edge2 = mesh.positions[corner[2]] - mesh.positions[corner[0]];
        const glm::vec2 uv1 = mesh.texCoords0[corner[1]] - mesh.texCoords0[corner[0]];
        const glm::vec2 uv2 = mesh.texCoords0[corner[2]] - mesh.texCoords0[corner[0]];
        const float determinant = uv1.x * uv2.y - uv1.y * uv2.x;
        ASSERT_NE(determinant, 0.0F) << name;
        const glm::vec3 alongU = (edge1 * uv2.y - edge2 * uv1.y) / determinant;
        const glm::vec3 alongV = (edge2 * uv1.x - edge1 * uv2.x) / determinant;
        for (const std::uint32_t vertex : corner) {
            const glm::vec3 normal = mesh.normals[vertex];
            const glm::vec4 tangent = mesh.tangents[vertex];
            const glm::vec3 bitangent = glm::cross(normal, glm::vec3(tangent)) * tangent.w;
            ASSERT_GT(glm::dot(glm::cross(edge1, edge2), normal), 0.0F) << name;
            ASSERT_GT(glm::dot(alongU, glm::vec3(tangent)), 0.0F) << name;
            // V runs down the image, and the bitangent up.
            ASSERT_LT(glm::dot(alongV, bitangent), 0.0F) << name;
        }
    }
}

}  // namespace

TEST(Shapes, ClosedShapesEncloseTheirVolume) {
    const float pi = glm::pi<float>();
    EXPECT_NEAR(enclosedVolume(sphere(1.0F, 96, 48)), 4.0F / 3.0F * pi, 0.02F);
    EXPECT_NEAR(enclosedVolume(torus(2.0F, 0.5F, 128, 64)), 2.0F * pi * pi * 2.0F * 0.25F, 0.05F);
    EXPECT_NEAR(enclosedVolume(box({1.0F, 2.0F, 3.0F})), 6.0F, 1e-5F);
    // This is the Minkowski sum of a cube of side 0.8 and a ball of radius 0.1.
    const float rounded = 0.512F + 6.0F * 0.64F * 0.1F + 3.0F * pi * 0.01F * 0.8F + 4.0F / 3.0F * pi * 0.001F;
    EXPECT_NEAR(enclosedVolume(roundedBox({1.0F, 1.0F, 1.0F}, 0.1F, 8)), rounded, 0.002F);
    const std::array<glm::vec2, 4> can{{{0.0F, 1.0F}, {0.5F, 1.0F}, {0.5F, 0.0F}, {0.0F, 0.0F}}};
    EXPECT_NEAR(enclosedVolume(lathe(can, false, 128, 1)), pi * 0.25F, 0.002F);
    EXPECT_GT(enclosedVolume(torusKnot(2, 3, 1.0F, 0.4F, 0.1F, 256, 24)), 0.2F);
    EXPECT_GT(enclosedVolume(gem(1.0F, 8)), 1.0F);
}

TEST(Shapes, FramesFollowTheTextureCoordinates) {
    expectConsistentFrames(sphere(1.0F, 32, 16), "sphere");
    expectConsistentFrames(torus(1.0F, 0.25F, 48, 24), "torus");
    expectConsistentFrames(torusKnot(2, 3, 0.4F, 0.19F, 0.1F, 384, 32), "torus knot");
    expectConsistentFrames(box({1.0F, 2.0F, 3.0F}), "box");
    expectConsistentFrames(roundedBox({1.0F, 0.5F, 0.7F}, 0.1F, 4), "rounded box");
    expectConsistentFrames(panel({2.0F, 1.0F}), "panel");
    expectConsistentFrames(gateWall({8.0F, 4.0F, 0.2F}, {0.5F, 2.0F}, 1.2F), "gate wall");
    const std::array<glm::vec2, 4> profile{{{0.1F, 1.0F}, {0.4F, 0.7F}, {0.2F, 0.3F}, {0.3F, 0.0F}}};
    expectConsistentFrames(lathe(profile, true, 48, 12), "vase");
    expectConsistentFrames(lathe(profile, false, 48, 1), "cones");
    expectConsistentFrames(rosette(5, 1.0F), "rosette");
}

TEST(Shapes, GateWallHasAHoleOfItsSize) {
    const MeshData wall = gateWall({8.0F, 4.0F, 0.2F}, {0.5F, 2.0F}, 1.2F);
    double area = 0.0;
    for (std::size_t at = 0; at < wall.indices.size(); at += 3) {
        const glm::vec3 a = wall.positions[wall.indices[at]];
        area += 0.5 * static_cast<double>(glm::length(glm::cross(wall.positions[wall.indices[at + 1]] - a,
                                                                 wall.positions[wall.indices[at + 2]] - a)));
    }
    EXPECT_NEAR(area, 2.0 * (32.0 - glm::pi<double>() * 1.44), 0.02);
}

}  // namespace gallery::test

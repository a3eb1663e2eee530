// Shapes with flat parts and edges: boxes, walls, the gem, leaves.
#include "shapes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace gallery {

namespace {

struct Face {
    glm::vec3 right;
    glm::vec3 up;
    glm::vec3 normal;  // cross(right, up)
};

constexpr std::array<Face, 6> kFaces{{
    {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}},
    {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
    {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}},
}};

// Adds a vertex of a flat face: u to the right, v down.
void addVertex(MeshData& mesh, const Face& face, const glm::vec3& position, const glm::vec2& metres,
               const glm::vec2& unit) {
    mesh.positions.push_back(position);
    mesh.normals.push_back(face.normal);
    mesh.tangents.emplace_back(face.right, 1.0F);
    mesh.texCoords0.push_back(metres);
    mesh.texCoords1.push_back(unit);
}

void addQuad(MeshData& mesh, const Face& face, const glm::vec3& centre, const glm::vec2& size) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::vec2 unit : {glm::vec2(0, 0), glm::vec2(0, 1), glm::vec2(1, 1), glm::vec2(1, 0)}) {
        const glm::vec3 position =
            centre + face.right * ((unit.x - 0.5F) * size.x) + face.up * ((0.5F - unit.y) * size.y);
        addVertex(mesh, face, position, unit * size, unit);
    }
    mesh.indices.insert(mesh.indices.end(), {base, base + 1, base + 2, base, base + 2, base + 3});
}

// Returns where the ray from `from` along `direction` leaves the rectangle.
glm::vec2 rectangleExit(const glm::vec2& from, const glm::vec2& direction, const glm::vec2& low,
                        const glm::vec2& high) {
    float distance = 1e30F;
    for (int axis = 0; axis < 2; ++axis) {
        if (std::abs(direction[axis]) > 1e-6F) {
            const float bound = direction[axis] > 0.0F ? high[axis] : low[axis];
            distance = std::min(distance, (bound - from[axis]) / direction[axis]);
        }
    }
    return glm::clamp(from + direction * distance, low, high);
}

// The angles about `centre` at which a wall is cut: evenly spaced, and at the rectangle's corners.
std::vector<float> gateAngles(const glm::vec2& centre, const glm::vec2& low, const glm::vec2& high) {
    constexpr int kSteps = 96;
    std::vector<float> angles;
    angles.reserve(kSteps + 4);
    for (int step = 0; step < kSteps; ++step) {
        angles.push_back(glm::two_pi<float>() * static_cast<float>(step) / static_cast<float>(kSteps));
    }
    for (const glm::vec2 corner : {low, high, glm::vec2(low.x, high.y), glm::vec2(high.x, low.y)}) {
        const glm::vec2 toCorner = corner - centre;
        const float angle = std::atan2(toCorner.y, toCorner.x);
        angles.push_back(angle < 0.0F ? angle + glm::two_pi<float>() : angle);
    }
    std::sort(angles.begin(), angles.end());
    return angles;
}

}  // namespace

MeshData box(const glm::vec3& size) {
    MeshData mesh;
    for (const Face& face : kFaces) {
        const glm::vec3 centre = face.normal * size * 0.5F;
        const glm::vec2 faceSize(glm::dot(glm::abs(face.right), size), glm::dot(glm::abs(face.up), size));
        addQuad(mesh, face, centre, faceSize);
    }
    return mesh;
}

MeshData panel(const glm::vec2& size) {
    MeshData mesh;
    addQuad(mesh, kFaces[4], glm::vec3(0.0F), size);
    return mesh;
}

MeshData roundedBox(const glm::vec3& size, float radius, int segments) {
    // The steps of the cube's coordinate within one edge. The tangent spaces them evenly by angle.
    std::vector<float> steps;
    for (int step = 0; step <= segments; ++step) {
        const float angle =
            glm::quarter_pi<float>() * static_cast<float>(step) / static_cast<float>(segments);
        steps.push_back(std::tan(angle));
    }
    // One face as a surface whose parameter selects a line of that spacing.
    const auto coordinate = [&](float parameter, float half) {
        const auto lines = 2 * (segments + 1);
        const int line = std::clamp(static_cast<int>(std::lround(parameter * static_cast<float>(lines - 1))),
                                    0, lines - 1);
        const int inEdge = line <= segments ? segments - line : line - segments - 1;
        const float reach = half - radius + radius * steps[static_cast<std::size_t>(inEdge)];
        return line <= segments ? -reach : reach;
    };
    MeshData mesh;
    const auto cells = 2 * segments + 1;
    for (const Face& face : kFaces) {
        const glm::vec3 half = size * 0.5F;
        const glm::vec2 faceHalf(glm::dot(glm::abs(face.right), half), glm::dot(glm::abs(face.up), half));
        MeshData side = grid(cells, cells, [&](float u, float v) {
            const glm::vec3 onCube = face.normal * half + face.right * coordinate(u, faceHalf.x) -
                                     face.up * coordinate(v, faceHalf.y);
            const glm::vec3 inner = glm::clamp(onCube, radius - half, half - radius);
            const glm::vec3 normal = glm::normalize(onCube - inner);
            return SurfacePoint{inner + normal * radius, normal};
        });
        for (std::size_t vertex = 0; vertex < side.positions.size(); ++vertex) {
            const glm::vec3& normal = side.normals[vertex];
            side.tangents[vertex] =
                glm::vec4(glm::normalize(face.right - normal * glm::dot(face.right, normal)), 1.0F);
            side.texCoords0[vertex] = {glm::dot(side.positions[vertex], face.right) + faceHalf.x,
                                       faceHalf.y - glm::dot(side.positions[vertex], face.up)};
        }
        append(mesh, side);
    }
    return mesh;
}

MeshData gateWall(const glm::vec3& size, const glm::vec2& holeCentre, float holeRadius) {
    const glm::vec2 low(-size.x * 0.5F, 0.0F);
    const glm::vec2 high(size.x * 0.5F, size.y);
    const std::vector<float> angles = gateAngles(holeCentre, low, high);
    MeshData mesh;
    for (const Face& face : {kFaces[4], kFaces[5]}) {
        const bool front = face.normal.z > 0.0F;
        const auto base = static_cast<std::uint32_t>(mesh.positions.size());
        const auto addPoint = [&](const glm::vec2& point) {
            const glm::vec2 metres((point.x - low.x) * face.right.x, high.y - point.y);
            const glm::vec2 unit(0.5F + point.x * face.right.x / size.x, metres.y / size.y);
            addVertex(mesh, face, glm::vec3(point, face.normal.z * size.z * 0.5F), metres, unit);
        };
        for (const float angle : angles) {
            const glm::vec2 direction(std::cos(angle), std::sin(angle));
            addPoint(holeCentre + direction * holeRadius);
            addPoint(rectangleExit(holeCentre, direction, low, high));
        }
        const auto count = static_cast<std::uint32_t>(angles.size());
        for (std::uint32_t step = 0; step < count; ++step) {
            const std::uint32_t here = base + 2 * step;
            const std::uint32_t next = base + 2 * ((step + 1) % count);
            const std::uint32_t first = front ? here + 1 : next;
            const std::uint32_t last = front ? next : here + 1;
            mesh.indices.insert(mesh.indices.end(), {here, first, next + 1, here, next + 1, last});
        }
    }
    return mesh;
}

MeshData gem(float radius, int sides) {
    MeshData mesh;
    const auto ring = [&](float ringRadius, float height, float turn) {
        for (int side = 0; side < sides; ++side) {
            const float angle =
                glm::two_pi<float>() * (static_cast<float>(side) + turn) / static_cast<float>(sides);
            mesh.positions.emplace_back(radius * ringRadius * std::sin(angle), radius * height,
                                        radius * ringRadius * std::cos(angle));
        }
    };
    // Table, crown, girdle and pavilion, with proportions near those of a brilliant.
    ring(0.55F, 0.35F, 0.0F);
    ring(0.85F, 0.20F, 0.5F);
    ring(1.00F, 0.00F, 0.0F);
    ring(0.60F, -0.40F, 0.5F);
    mesh.positions.emplace_back(0.0F, radius * 0.35F, 0.0F);
    mesh.positions.emplace_back(0.0F, radius * -0.85F, 0.0F);
    const auto count = static_cast<std::uint32_t>(sides);
    const std::uint32_t top = 4 * count;
    for (std::uint32_t side = 0; side < count; ++side) {
        const std::uint32_t next = (side + 1) % count;
        const auto at = [&](std::uint32_t ringIndex, std::uint32_t place) {
            return ringIndex * count + place;
        };
        const std::initializer_list<std::uint32_t> facets = {
            top,         at(0, side), at(0, next),  // table
            at(0, side), at(1, side), at(0, next),  // star
            at(0, next), at(1, side), at(2, next),  // crown, left half of a kite
            at(0, next), at(2, next), at(1, next),  // crown, right half
            at(1, side), at(2, side), at(2, next),  // upper girdle
            at(2, side), at(3, side), at(2, next),  // lower girdle
            at(2, next), at(3, side), at(3, next),  // pavilion main
            at(3, side), top + 1,     at(3, next),  // culet
        };
        mesh.indices.insert(mesh.indices.end(), facets);
    }
    return mesh;
}

MeshData rosette(int count, float length) {
    MeshData mesh;
    for (int leaf = 0; leaf < count; ++leaf) {
        // The golden angle spreads leaves as plants do. Inner leaves are steeper and shorter.
        const float age = static_cast<float>(leaf) / static_cast<float>(count);
        const float size = length * (0.65F + 0.35F * age);
        const float lean = 0.25F + 0.95F * age;
        const MeshData blade = grid(4, 14, [=](float u, float v) {
            const float along = 1.0F - v;
            const float bend = lean + 0.7F * along * along;
            const float width = 0.13F * size * (1.0F - along * along * along) * (0.55F + along);
            const float across = 1.0F - 2.0F * u;
            const float fold = 0.35F * width * across * across;
            const glm::vec3 out(0.0F, std::cos(bend), std::sin(bend));
            const glm::vec3 normal =
                glm::normalize(glm::vec3(-0.5F * across, std::sin(bend), -std::cos(bend)));
            return SurfacePoint{out * (size * along) + glm::vec3(across * width, fold, 0.0F), normal};
        });
        const float angle = 2.39996323F * static_cast<float>(leaf);
        append(mesh, blade, glm::rotate(glm::mat4(1.0F), angle, glm::vec3(0.0F, 1.0F, 0.0F)));
    }
    return mesh;
}

}  // namespace gallery

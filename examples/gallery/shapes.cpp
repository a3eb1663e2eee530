// Surfaces of revolution, tubes and spheres: all shapes that one parametric grid covers.
#include "shapes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace gallery {

namespace {

constexpr float kTwoPi = glm::two_pi<float>();

// Returns the direction in which u grows, made orthogonal to the normal. At poles, where u has no effect, it
// takes the tangent of a neighbouring row.
glm::vec4 tangentAt(const Surface& surface, float u, float v, const glm::vec3& normal) {
    constexpr float kStep = 1.0F / 1024.0F;
    const float row = std::clamp(v, 0.01F, 0.99F);
    const glm::vec3 along = surface(u + kStep, row).position - surface(u - kStep, row).position;
    return {glm::normalize(along - normal * glm::dot(along, normal)), 1.0F};
}

void addTriangle(MeshData& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const glm::vec3 edge1 = mesh.positions[b] - mesh.positions[a];
    const glm::vec3 edge2 = mesh.positions[c] - mesh.positions[a];
    // Half a quad collapses at each pole. 1e-12 m² is far below the area of any visible triangle.
    if (glm::length(glm::cross(edge1, edge2)) > 1e-12F) {
        mesh.indices.insert(mesh.indices.end(), {a, b, c});
    }
}

// Returns a point and the direction of travel on a Catmull-Rom spline through `points`, t within [0, 1].
glm::vec2 splinePoint(std::span<const glm::vec2> points, float t) {
    const auto last = static_cast<int>(points.size()) - 1;
    const float scaled = std::clamp(t, 0.0F, 1.0F) * static_cast<float>(last);
    const int segment = std::min(static_cast<int>(scaled), last - 1);
    const float f = scaled - static_cast<float>(segment);
    const auto point = [&](int index) {
        return points[static_cast<std::size_t>(std::clamp(index, 0, last))];
    };
    const glm::vec2 p0 = point(segment - 1);
    const glm::vec2 p1 = point(segment);
    const glm::vec2 p2 = point(segment + 1);
    const glm::vec2 p3 = point(segment + 2);
    return 0.5F * (2.0F * p1 + (p2 - p0) * f + (2.0F * p0 - 5.0F * p1 + 4.0F * p2 - p3) * f * f +
                   (3.0F * p1 - p0 - 3.0F * p2 + p3) * f * f * f);
}

// Turns a point of a profile about +Y. `travel` is the direction of the profile, which goes down on the
// outside.
SurfacePoint turned(const glm::vec2& point, const glm::vec2& travel, float u) {
    const float angle = kTwoPi * u;
    const glm::vec3 outward(std::sin(angle), 0.0F, std::cos(angle));
    const glm::vec2 normal = glm::normalize(glm::vec2(-travel.y, travel.x));
    return {outward * point.x + glm::vec3(0.0F, point.y, 0.0F),
            glm::normalize(outward * normal.x + glm::vec3(0.0F, normal.y, 0.0F))};
}

}  // namespace

MeshData grid(int columns, int rows, const Surface& surface) {
    MeshData mesh;
    for (int row = 0; row <= rows; ++row) {
        for (int column = 0; column <= columns; ++column) {
            const float u = static_cast<float>(column) / static_cast<float>(columns);
            const float v = static_cast<float>(row) / static_cast<float>(rows);
            const SurfacePoint point = surface(u, v);
            mesh.positions.push_back(point.position);
            mesh.normals.push_back(point.normal);
            mesh.tangents.push_back(tangentAt(surface, u, v, point.normal));
            mesh.texCoords0.emplace_back(u, v);
        }
    }
    mesh.texCoords1 = mesh.texCoords0;
    const auto stride = static_cast<std::uint32_t>(columns + 1);
    for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(rows); ++row) {
        for (std::uint32_t column = 0; column < static_cast<std::uint32_t>(columns); ++column) {
            const std::uint32_t upperLeft = row * stride + column;
            addTriangle(mesh, upperLeft, upperLeft + stride, upperLeft + stride + 1);
            addTriangle(mesh, upperLeft, upperLeft + stride + 1, upperLeft + 1);
        }
    }
    return mesh;
}

MeshData sphere(float radius, int columns, int rows) {
    return grid(columns, rows, [radius](float u, float v) {
        const float polar = glm::pi<float>() * v;
        const float angle = kTwoPi * u;
        // The sine of the float nearest to π is -8.7e-8. It is clamped so that the pole is one point.
        const float ring = v <= 0.0F || v >= 1.0F ? 0.0F : std::sin(polar);
        const glm::vec3 normal(ring * std::sin(angle), std::cos(polar), ring * std::cos(angle));
        return SurfacePoint{normal * radius, glm::normalize(normal)};
    });
}

MeshData torus(float majorRadius, float minorRadius, int columns, int rows) {
    return grid(columns, rows, [=](float u, float v) {
        const float around = kTwoPi * u;
        const float tube = glm::pi<float>() - kTwoPi * v;
        const glm::vec3 outward(std::sin(around), 0.0F, std::cos(around));
        const glm::vec3 normal = outward * std::cos(tube) + glm::vec3(0.0F, std::sin(tube), 0.0F);
        return SurfacePoint{outward * majorRadius + normal * minorRadius, glm::normalize(normal)};
    });
}

MeshData torusKnot(int p, int q, float majorRadius, float knotRadius, float tubeRadius, int columns,
                   int rows) {
    const auto curve = [=](float u) {
        const float turn = kTwoPi * u * static_cast<float>(p);
        const float hole = kTwoPi * u * static_cast<float>(q);
        const float distance = majorRadius + knotRadius * std::cos(hole);
        return glm::vec3(distance * std::cos(turn), knotRadius * std::sin(hole), distance * std::sin(turn));
    };
    return grid(columns, rows, [=](float u, float v) {
        constexpr float kStep = 1.0F / 2048.0F;
        const glm::vec3 centre = curve(u);
        const glm::vec3 forward = glm::normalize(curve(u + kStep) - curve(u - kStep));
        // The vector goes from the core circle of the torus to the curve. It is never parallel to the curve,
        // and has the same period.
        const float turn = kTwoPi * u * static_cast<float>(p);
        const glm::vec3 core(majorRadius * std::cos(turn), 0.0F, majorRadius * std::sin(turn));
        const glm::vec3 away = centre - core;
        const glm::vec3 side = glm::normalize(away - forward * glm::dot(away, forward));
        const glm::vec3 other = glm::cross(forward, side);
        const glm::vec3 normal = side * std::cos(kTwoPi * v) + other * std::sin(kTwoPi * v);
        return SurfacePoint{centre + normal * tubeRadius, glm::normalize(normal)};
    });
}

MeshData lathe(std::span<const glm::vec2> profile, bool smooth, int columns, int rowsPerSegment) {
    const auto segments = static_cast<int>(profile.size()) - 1;
    if (smooth) {
        return grid(columns, segments * rowsPerSegment, [profile](float u, float v) {
            constexpr float kStep = 1.0F / 512.0F;
            const glm::vec2 travel = splinePoint(profile, v + kStep) - splinePoint(profile, v - kStep);
            return turned(splinePoint(profile, v), travel, u);
        });
    }
    MeshData mesh;
    for (std::size_t segment = 0; segment + 1 < profile.size(); ++segment) {
        const glm::vec2 from = profile[segment];
        const glm::vec2 to = profile[segment + 1];
        append(mesh, grid(columns, rowsPerSegment,
                          [&](float u, float v) { return turned(glm::mix(from, to, v), to - from, u); }));
    }
    return mesh;
}

}  // namespace gallery

#include "oracle/world.h"

#include "gltf/motion/transform.h"

#include <algorithm>
#include <array>

namespace glint::oracle {
namespace {

constexpr double kOwnSurface = 1e-9;  // share of the scene's size

glm::dmat4 toMatrix(const gltf::Matrix4& m) {
    glm::dmat4 matrix;
    for (std::size_t i = 0; i < m.size(); ++i) {
        matrix[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = m[i];
    }
    return matrix;
}

Vec3 colorAt(const gltf::Primitive& primitive, std::uint32_t index) {
    if (primitive.colors.empty()) {
        return Vec3(1.0);
    }
    const gltf::Float4& color = primitive.colors[index];
    return {color[0], color[1], color[2]};
}

void appendPrimitive(const gltf::Scene& scene, const gltf::Primitive& primitive, const glm::dmat4& world,
                     std::vector<Triangle>& triangles) {
    const glm::dmat3 linear(world);
    const glm::dmat3 normalMatrix = glm::transpose(glm::inverse(linear));
    const bool mirrored = glm::determinant(linear) < 0.0;
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        Triangle triangle;
        triangle.material = primitive.material;
        triangle.doubleSided = scene.materials[static_cast<std::size_t>(primitive.material)].doubleSided;
        std::array<std::uint32_t, 3> corners{primitive.indices[i], primitive.indices[i + 1],
                                             primitive.indices[i + 2]};
        if (mirrored) {
            // In glTF a negative determinant reverses the winding.
            std::swap(corners[1], corners[2]);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            triangle.positions[k] = Vec3(world * glm::dvec4(toVec(primitive.positions[corners[k]]), 1.0));
            triangle.colors[k] = colorAt(primitive, corners[k]);
        }
        const Vec3 flat = glm::normalize(glm::cross(triangle.positions[1] - triangle.positions[0],
                                                    triangle.positions[2] - triangle.positions[0]));
        for (std::size_t k = 0; k < 3; ++k) {
            triangle.normals[k] = primitive.normals.empty()
                                      ? flat
                                      : glm::normalize(normalMatrix * toVec(primitive.normals[corners[k]]));
        }
        triangles.push_back(triangle);
    }
}

std::vector<Triangle> trianglesOf(const gltf::Scene& scene) {
    std::vector<Triangle> triangles;
    for (const gltf::Node& node : scene.nodes) {
        for (const gltf::Matrix4& world : gltf::placesOf(scene, node)) {
            for (const gltf::Primitive& primitive :
                 scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
                appendPrimitive(scene, primitive, toMatrix(world), triangles);
            }
        }
    }
    return triangles;
}

double largestCoordinate(const std::vector<Triangle>& triangles) {
    double largest = 0.0;
    for (const Triangle& triangle : triangles) {
        for (const Vec3& position : triangle.positions) {
            const Vec3 size = glm::abs(position);
            largest = std::max({largest, size.x, size.y, size.z});
        }
    }
    return largest;
}

Hit surfaceAt(const Triangle& triangle, const TriangleHit& found, const Ray& ray) {
    const double w = 1.0 - found.u - found.v;
    const auto mix = [&](const std::array<Vec3, 3>& values) {
        return w * values[0] + found.u * values[1] + found.v * values[2];
    };
    Hit hit;
    hit.distance = found.distance;
    hit.position = mix(triangle.positions);
    hit.geometricNormal = glm::normalize(glm::cross(triangle.positions[1] - triangle.positions[0],
                                                    triangle.positions[2] - triangle.positions[0]));
    hit.normal = glm::normalize(mix(triangle.normals));
    hit.color = mix(triangle.colors);
    hit.material = triangle.material;
    hit.front = glm::dot(hit.geometricNormal, ray.direction) < 0.0;
    return hit;
}

}  // namespace

World::World() : triangles_(std::make_unique<Triangles>(std::vector<Triangle>{})) {}

World::World(const gltf::Scene& scene) {
    std::vector<Triangle> triangles = trianglesOf(scene);
    size_ = largestCoordinate(triangles);
    triangles_ = std::make_unique<Triangles>(std::move(triangles));
}

void World::addSphere(const Vec3& center, double radius, int material) {
    spheres_.push_back({center, radius, material});
    const Vec3 far = glm::abs(center) + radius;
    size_ = std::max({size_, far.x, far.y, far.z});
}

void World::hitSphere(const Sphere& sphere, const Ray& ray, Faces faces, double nearest,
                      std::optional<Hit>& best, double& limit) const {
    const Vec3 toCenter = sphere.center - ray.origin;
    const double along = glm::dot(toCenter, ray.direction);
    const Vec3 across = toCenter - along * ray.direction;
    const double half2 = sphere.radius * sphere.radius - glm::dot(across, across);
    if (half2 <= 0.0) {
        return;
    }
    const double half = std::sqrt(half2);
    for (const bool entry : {true, false}) {
        const double distance = entry ? along - half : along + half;
        if (distance <= nearest || distance >= limit || (!entry && faces == Faces::Culled)) {
            continue;
        }
        limit = distance;
        Hit hit;
        hit.distance = distance;
        hit.normal = glm::normalize(ray.origin + distance * ray.direction - sphere.center);
        hit.geometricNormal = hit.normal;
        // The position is exactly on the sphere, so that the next ray starts on it.
        hit.position = sphere.center + sphere.radius * hit.normal;
        hit.material = sphere.material;
        hit.front = entry;
        best = hit;
        return;
    }
}

std::optional<Hit> World::closest(const Ray& ray, Faces faces, double farthest) const {
    const double nearest = kOwnSurface * size_;
    std::optional<Hit> best;
    double limit = farthest;
    TriangleHit found;
    if (triangles_->closest(ray.origin, ray.direction, nearest, limit, faces == Faces::Culled, found)) {
        limit = found.distance;
        best = surfaceAt(triangles_->at(found.triangle), found, ray);
    }
    for (const Sphere& sphere : spheres_) {
        hitSphere(sphere, ray, faces, nearest, best, limit);
    }
    return best;
}

bool World::meetsGround(const Ray& ray) const {
    const std::optional<Hit> hit = closest(ray, Faces::Culled);
    return hit && std::abs(hit->position.y) < 1e-6 && hit->geometricNormal.y > 0.999;
}

bool World::visible(const Ray& ray, double distance) const {
    return !closest(ray, Faces::All, distance);
}

}  // namespace glint::oracle

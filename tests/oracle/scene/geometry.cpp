#include "oracle/scene/geometry.h"

#include "gltf/motion/transform.h"

#include <algorithm>
#include <cmath>

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

// Interpolates values of a triangle's corners by their weights.
template <class Value>
auto mixed(const std::vector<Value>& values, const std::array<std::uint32_t, 3>& corners,
           const Vec3& weights) {
    return weights.x * toVec(values[corners[0]]) + weights.y * toVec(values[corners[1]]) +
           weights.z * toVec(values[corners[2]]);
}

}  // namespace

struct SceneGeometry::Source {
    const gltf::Primitive* primitive = nullptr;
    glm::dmat3 linear{1.0};
    glm::dmat3 normalMatrix{1.0};
    bool mirrored = false;
    std::array<std::uint32_t, 3> corners{};  // counter-clockwise in the world, seen from the front
};

SceneGeometry::SceneGeometry(const gltf::Scene& scene, PointIsThere isThere)
    : scene_(scene), isThere_(std::move(isThere)) {
    std::vector<Triangle> triangles;
    double size = 0.0;
    for (const gltf::Node& node : scene.nodes) {
        for (const gltf::Matrix4& place : gltf::placesOf(scene, node)) {
            const glm::dmat4 world = toMatrix(place);
            for (const gltf::Primitive& primitive :
                 scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
                Source source{&primitive, glm::dmat3(world), {}, false, {}};
                source.normalMatrix = glm::transpose(glm::inverse(source.linear));
                source.mirrored = glm::determinant(source.linear) < 0.0;
                for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
                    source.corners = {primitive.indices[i], primitive.indices[i + 1],
                                      primitive.indices[i + 2]};
                    if (source.mirrored) {
                        // glTF: a negative determinant turns the winding.
                        std::swap(source.corners[1], source.corners[2]);
                    }
                    Triangle triangle;
                    triangle.material = primitive.material;
                    triangle.doubleSided =
                        scene.materials[static_cast<std::size_t>(primitive.material)].doubleSided;
                    for (std::size_t k = 0; k < 3; ++k) {
                        const Vec3 local = toVec(primitive.positions[source.corners[k]]);
                        triangle.positions[k] = Vec3(world * glm::dvec4(local, 1.0));
                        const Vec3 extent = glm::abs(triangle.positions[k]);
                        size = std::max({size, extent.x, extent.y, extent.z});
                    }
                    triangles.push_back(triangle);
                    sources_.push_back(source);
                }
            }
        }
    }
    for (const materials::Material& material : scene.materials) {
        const bool transmits =
            material["transmissionFactor"] > 0.0F || material["diffuseTransmissionFactor"] > 0.0F;
        volumes_.push_back(transmits && material["thicknessFactor"] > 0.0F);
    }
    nearest_ = kOwnSurface * size;
    triangles_ = std::make_unique<Triangles>(std::move(triangles));
}

SceneGeometry::~SceneGeometry() = default;

std::size_t SceneGeometry::triangleCount() const {
    return sources_.size();
}

SurfacePoint SceneGeometry::pointOf(const TriangleHit& hit, const Ray& ray) const {
    const Triangle& triangle = triangles_->at(hit.triangle);
    const Source& source = sources_[hit.triangle];
    const gltf::Primitive& primitive = *source.primitive;
    const auto& corners = source.corners;
    const Vec3 weights(1.0 - hit.u - hit.v, hit.u, hit.v);
    SurfacePoint point;
    point.distance = hit.distance;
    point.triangle = hit.triangle;
    point.material = triangle.material;
    point.edges = {triangle.positions[1] - triangle.positions[0],
                   triangle.positions[2] - triangle.positions[0]};
    point.position = triangle.positions[0] + hit.u * point.edges[0] + hit.v * point.edges[1];
    point.geometricNormal = glm::normalize(glm::cross(point.edges[0], point.edges[1]));
    point.front = glm::dot(point.geometricNormal, ray.direction) < 0.0;
    point.normal = point.geometricNormal;
    if (!primitive.normals.empty()) {
        const Vec3 normal = source.normalMatrix * mixed(primitive.normals, corners, weights);
        const double length = glm::length(normal);
        point.normal = length > 0.0 ? normal / length : point.geometricNormal;
        if (!primitive.tangents.empty()) {
            point.tangent = source.linear * Vec3(mixed(primitive.tangents, corners, weights));
            const double sign = primitive.tangents[corners[0]][3];
            point.handedness = source.mirrored ? -sign : sign;
        }
    }
    for (std::size_t set = 0; set < 2; ++set) {
        const std::vector<gltf::Float2>& all = set == 0 ? primitive.texCoords0 : primitive.texCoords1;
        if (!all.empty()) {
            point.texCoords[set] = mixed(all, corners, weights);
            point.texCoordEdges[set] = {toVec(all[corners[1]]) - toVec(all[corners[0]]),
                                        toVec(all[corners[2]]) - toVec(all[corners[0]])};
        }
    }
    if (!primitive.colors.empty()) {
        point.color = mixed(primitive.colors, corners, weights);
    }
    const glm::dmat3 squares = glm::matrixCompMult(source.linear, source.linear);
    const Vec3 sums = squares[0] + squares[1] + squares[2];
    point.scale = std::sqrt((sums.x + sums.y + sums.z) / 3.0);
    return point;
}

bool SceneGeometry::isThereAt(const TriangleHit& hit, const Ray& ray) const {
    const auto material = static_cast<std::size_t>(triangles_->at(hit.triangle).material);
    return scene_.materials[material].alphaMode != materials::AlphaMode::Mask || isThere_(pointOf(hit, ray));
}

SurfacePoint SceneGeometry::pointAt(std::uint32_t triangle, double u, double v, const Vec3& direction) const {
    return pointOf({0.0, triangle, u, v}, {Vec3(0.0), direction});
}

bool SceneGeometry::exists(const SurfacePoint& point) const {
    return scene_.materials[static_cast<std::size_t>(point.material)].alphaMode !=
               materials::AlphaMode::Mask ||
           isThere_(point);
}

std::optional<SurfacePoint> SceneGeometry::closest(const Ray& ray) const {
    return closest(ray, Backs::None, kInfinity);
}

std::optional<SurfacePoint> SceneGeometry::closest(const Ray& ray, Backs backs, double farthest) const {
    const auto accepts = [&](const TriangleHit& hit) {
        const Triangle& triangle = triangles_->at(hit.triangle);
        const bool seen =
            triangle.doubleSided || backs == Backs::All ||
            (backs == Backs::OfVolumes && volumes_[static_cast<std::size_t>(triangle.material)]) ||
            !triangles_->showsBack(hit.triangle, ray.direction);
        return seen && isThereAt(hit, ray);
    };
    TriangleHit hit;
    if (!triangles_->closest(ray.origin, ray.direction, nearest_, farthest, accepts, hit)) {
        return std::nullopt;
    }
    return pointOf(hit, ray);
}

bool SceneGeometry::visible(const Ray& ray, double distance) const {
    return !triangles_->blocked(ray.origin, ray.direction, nearest_, distance,
                                [&](const TriangleHit& hit) { return isThereAt(hit, ray); });
}

}  // namespace glint::oracle

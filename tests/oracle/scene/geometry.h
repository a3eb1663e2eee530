// The triangles of a scene with everything that materials read about them, in double precision.
#pragma once

#include "gltf/scene.h"
#include "oracle/triangles.h"
#include "oracle/world.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace glint::oracle {

// The point where a ray meets a surface. Attributes are interpolated as the file gives them, and then
// transformed into the world.
struct SurfacePoint {
    double distance = 0.0;
    Vec3 position{0.0};
    Vec3 geometricNormal{0.0};  // unit, out of the front
    Vec3 normal{0.0};           // unit, interpolated, out of the front
    bool front = true;          // the ray came from the front
    std::optional<Vec3> tangent;
    double handedness = 1.0;  // of the tangent's frame
    std::array<std::optional<Vec2>, 2> texCoords;
    std::array<Vec3, 2> edges{};                         // from the first corner to the second and the third
    std::array<std::array<Vec2, 2>, 2> texCoordEdges{};  // by UV set
    glm::dvec4 color{1.0};                               // COLOR_0
    double scale = 1.0;  // metres in one of the mesh, root mean square over its axes
    int material = 0;
    std::uint32_t triangle = 0;
};

// Returns whether a surface exists at a point, for alpha masks.
using PointIsThere = std::function<bool(const SurfacePoint&)>;

// Which backs of single-sided surfaces rays meet, besides all fronts.
enum class Backs : std::uint8_t {
    None,
    OfVolumes,  // where a volume ends
    All
};

class SceneGeometry {
public:
    // Takes the meshes of all nodes in their rest pose, without skins and morph targets. The scene must
    // outlive it. `isThere` is called for masked materials.
    SceneGeometry(const gltf::Scene& scene, PointIsThere isThere);
    ~SceneGeometry();
    SceneGeometry(const SceneGeometry&) = delete;
    SceneGeometry& operator=(const SceneGeometry&) = delete;

    // Returns the nearest existing surface, ignoring the backs of single-sided ones. A surface within 1e-9 of
    // the scene's size is the one that the ray starts on, and is ignored.
    std::optional<SurfacePoint> closest(const Ray& ray) const;
    // Returns the nearest existing surface before `farthest`.
    std::optional<SurfacePoint> closest(const Ray& ray, Backs backs, double farthest) const;
    // Returns a place of a triangle, by the weights of its second and third corner, as a ray along
    // `direction` meets it. The distance is not set.
    SurfacePoint pointAt(std::uint32_t triangle, double u, double v, const Vec3& direction) const;
    const Triangle& triangle(std::uint32_t index) const {
        return triangles_->at(index);
    }
    // Returns whether the surface exists at a point: its alpha mask.
    bool exists(const SurfacePoint& point) const;
    // Returns whether no existing surface, front or back, is nearer than `distance`.
    bool visible(const Ray& ray, double distance) const;
    std::size_t triangleCount() const;

private:
    struct Source;  // of a triangle
    SurfacePoint pointOf(const TriangleHit& hit, const Ray& ray) const;
    bool isThereAt(const TriangleHit& hit, const Ray& ray) const;

    const gltf::Scene& scene_;
    PointIsThere isThere_;
    std::vector<Source> sources_;
    std::unique_ptr<Triangles> triangles_;
    std::vector<bool> volumes_;  // by material
    double nearest_ = 0.0;
};

}  // namespace glint::oracle

// Intersects triangles with Embree.
#pragma once

#include "oracle/vectors.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace glint::oracle {

struct Triangle {
    std::array<Vec3, 3> positions;
    std::array<Vec3, 3> normals;  // unit
    std::array<Vec3, 3> colors;   // linear
    int material = 0;
    bool doubleSided = false;
};

struct TriangleHit {
    double distance = 0.0;
    std::uint32_t triangle = 0;
    double u = 0.0;  // weights of the second and third corner
    double v = 0.0;
};

// Returns whether a triangle exists where a ray meets it.
using Accepts = std::function<bool(const TriangleHit&)>;

// Embree's rays and triangles have single precision (with RTC_SCENE_FLAG_ROBUST, which leaves no gaps between
// triangles). They decide which triangle is hit. The place is then computed in double precision on the
// triangle itself. A ray that passes an edge within single precision, 1e-7 of the coordinates, may get either
// neighbour.
class Triangles {
public:
    // Aborts if Embree fails.
    explicit Triangles(std::vector<Triangle> triangles);
    ~Triangles();
    Triangles(const Triangles&) = delete;
    Triangles& operator=(const Triangles&) = delete;

    const Triangle& at(std::uint32_t index) const {
        return triangles_[index];
    }
    // Returns the nearest hit in (nearest, farthest). If `culled` is set, back faces of single-sided
    // triangles are ignored.
    bool closest(const Vec3& origin, const Vec3& direction, double nearest, double farthest, bool culled,
                 TriangleHit& hit) const;
    // Returns the nearest hit that is accepted.
    bool closest(const Vec3& origin, const Vec3& direction, double nearest, double farthest,
                 const Accepts& accepts, TriangleHit& hit) const;
    // Returns whether any hit in (nearest, farthest) is accepted.
    bool blocked(const Vec3& origin, const Vec3& direction, double nearest, double farthest,
                 const Accepts& accepts) const;
    // Returns whether the triangle is seen from behind, by its winding.
    bool showsBack(std::uint32_t index, const Vec3& direction) const;

private:
    struct Embree;
    std::vector<Triangle> triangles_;
    std::unique_ptr<Embree> embree_;
};

}  // namespace glint::oracle

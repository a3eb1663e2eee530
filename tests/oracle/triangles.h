// Triangles by Embree.
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

// Whether a triangle is there where a ray meets it.
using Accepts = std::function<bool(const TriangleHit&)>;

// Embree's rays and triangles are of single precision (with RTC_SCENE_FLAG_ROBUST, which leaves no gaps
// between triangles); they say which triangle is hit. Where is then worked out in double precision on the
// triangle itself. A ray that passes an edge within single precision, 1e-7 of the coordinates, may be given
// either neighbour.
class Triangles {
public:
    // Aborts where Embree fails.
    explicit Triangles(std::vector<Triangle> triangles);
    ~Triangles();
    Triangles(const Triangles&) = delete;
    Triangles& operator=(const Triangles&) = delete;

    const Triangle& at(std::uint32_t index) const {
        return triangles_[index];
    }
    // The nearest hit in (nearest, farthest); `culled`: back faces of single-sided triangles are not there.
    bool closest(const Vec3& origin, const Vec3& direction, double nearest, double farthest, bool culled,
                 TriangleHit& hit) const;
    // The same of those that are accepted.
    bool closest(const Vec3& origin, const Vec3& direction, double nearest, double farthest,
                 const Accepts& accepts, TriangleHit& hit) const;
    // Whether any is in (nearest, farthest) and accepted.
    bool blocked(const Vec3& origin, const Vec3& direction, double nearest, double farthest,
                 const Accepts& accepts) const;
    // From behind, by the winding.
    bool showsBack(std::uint32_t index, const Vec3& direction) const;

private:
    struct Embree;
    std::vector<Triangle> triangles_;
    std::unique_ptr<Embree> embree_;
};

}  // namespace glint::oracle

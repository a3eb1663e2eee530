// What the oracle's rays can hit: the triangles of a scene, and spheres.
#pragma once

#include "gltf/scene.h"
#include "oracle/triangles.h"
#include "oracle/vectors.h"

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace glint::oracle {

struct Ray {
    Vec3 origin;
    Vec3 direction;  // unit
};

struct Hit {
    double distance = 0.0;
    Vec3 position{0.0};
    Vec3 geometricNormal{0.0};  // unit, out of the front
    Vec3 normal{0.0};           // unit, interpolated, out of the front
    Vec3 color{1.0};            // COLOR_0
    int material = 0;
    bool front = true;  // the ray came from the front
};

// All: rays hit both sides of everything. Culled: they pass the backs of single-sided surfaces.
enum class Faces { All, Culled };

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

class World {
public:
    // Makes a world without triangles.
    World();
    // Takes every primitive of every node, in the world. Only factors of materials and COLOR_0 are read.
    explicit World(const gltf::Scene& scene);

    // Adds a sphere without facets, with its front outside.
    void addSphere(const Vec3& center, double radius, int material = 0);

    // Returns the nearest hit. A ray may start on a surface: a hit within 1e-9 of the scene's size is on that
    // surface, and is ignored.
    std::optional<Hit> closest(const Ray& ray, Faces faces, double farthest = kInfinity) const;
    // Returns whether a ray first hits a front in the plane y = 0, culled: the floors of the tests.
    bool meetsGround(const Ray& ray) const;
    // Returns whether nothing, front or back, is nearer than `distance`.
    bool visible(const Ray& ray, double distance = kInfinity) const;

private:
    struct Sphere {
        Vec3 center;
        double radius;
        int material;
    };
    void hitSphere(const Sphere& sphere, const Ray& ray, Faces faces, double nearest,
                   std::optional<Hit>& best, double& limit) const;

    std::unique_ptr<Triangles> triangles_;
    std::vector<Sphere> spheres_;
    double size_ = 0.0;  // largest coordinate
};

}  // namespace glint::oracle

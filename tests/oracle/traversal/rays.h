// Makes the rays of the benchmark, and traces them with Embree for comparison.
#pragma once

#include <glint/scene_view.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace glint::traversal {

using Float3 = std::array<float, 3>;

// The layout is that of the kernel: scalar layout.
struct Ray {
    Float3 origin;
    Float3 direction;  // unit
};

struct Triangle {
    Float3 corners[3];
};

// Returns every triangle of every instance in the world. Joints and morph targets are ignored.
std::vector<Triangle> worldTriangles(const SceneView& scene);

// Makes rays in tiles of 8 x 8 pixels. The tiles are in a random order, so that the first rays are a sample
// of all.
inline constexpr std::size_t kTile = 64;
std::vector<Ray> cameraRays(const CameraView& camera, std::uint32_t width, std::uint32_t height);

class EmbreeScene {
public:
    // Aborts if Embree fails.
    explicit EmbreeScene(const std::vector<Triangle>& triangles);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    // Finds the distance of each ray's nearest hit, from either side of a triangle; it is negative if there
    // is none. Uses as many threads as the machine runs at once. Returns milliseconds.
    double trace(std::span<const Ray> rays, std::span<float> distances) const;
    // Returns rays that start where `rays` hit, in random directions above the surface (by the cosine), in
    // the same order.
    std::vector<Ray> bounces(std::span<const Ray> rays) const;

private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
};

}  // namespace glint::traversal

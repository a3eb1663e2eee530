// Rays of the benchmark, and Embree as what they are compared with.
#pragma once

#include <glint/scene_view.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace glint::traversal {

using Float3 = std::array<float, 3>;

// As the kernel reads it: scalar layout.
struct Ray {
    Float3 origin;
    Float3 direction;  // unit
};

struct Triangle {
    Float3 corners[3];
};

// Every triangle of every instance in the world, without joints and morph targets.
std::vector<Triangle> worldTriangles(const SceneView& scene);

// Rays in tiles of 8 x 8 pixels, tile by tile in a random order, so that the first rays are a sample of all.
inline constexpr std::size_t kTile = 64;
std::vector<Ray> cameraRays(const CameraView& camera, std::uint32_t width, std::uint32_t height);

class EmbreeScene {
public:
    // Aborts where Embree fails.
    explicit EmbreeScene(const std::vector<Triangle>& triangles);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    // The distance of each ray's nearest hit, negative where there is none, from either side of a triangle.
    // Takes as many threads as the machine runs at once; returns milliseconds.
    double trace(std::span<const Ray> rays, std::span<float> distances) const;
    // Rays from what `rays` hit, in random directions above the surface (by the cosine), in their order.
    std::vector<Ray> bounces(std::span<const Ray> rays) const;

private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
};

}  // namespace glint::traversal

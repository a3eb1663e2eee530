// Renders the light of whole scenes: punctual lights with hard shadows, emission, the sky, and one mirror
// reflection.
#pragma once

#include "oracle/scene/geometry.h"
#include "oracle/scene/surface.h"

#include <cstdint>
#include <vector>

namespace glint::oracle {

struct RendererSettings {
    GradientSky sky;
    // Only surfaces that are smoother reflect.
    double mirrorRoughness = 0.05;
    SrgbTable srgb = exactSrgb();
};

// The light along one ray of the camera.
struct CameraLight {
    Vec3 mean{0.0};
    // The variance of a renderer that chooses between coat and base by the light that each brings, and
    // chooses one light in what a mirror shows, by the light that each would bring without shadows.
    Vec3 variance{0.0};
    // The light for each of these choices; filled if a path is asked for.
    std::vector<Vec3> outcomes{};
};

// What decided the light of a ray.
struct Path {
    std::vector<std::uint32_t> triangles;  // met, in order: the camera's, then those in mirrors; kNothing
    std::vector<bool> visible;             // a light each that could reach a surface
    std::vector<int> materials;            // of the triangles
    bool grazing = false;                  // light or view within 1e-3 of a tangent plane

    static constexpr std::uint32_t kNothing = 0xFFFFFFFFU;
};

class SceneRenderer {
public:
    // Uses everything in the scene as it is; lights that a viewer adds are among the scene's. The scene must
    // outlive the object.
    SceneRenderer(const gltf::Scene& scene, const RendererSettings& settings);

    const gltf::Scene& scene() const {
        return textures_.scene();
    }
    // Appends to `path` if it is not null. Several threads may call this.
    CameraLight radiance(const Ray& ray, Path* path = nullptr) const;
    const SceneGeometry& geometry() const {
        return geometry_;
    }

private:
    struct Direct;  // of one light
    std::vector<Direct> directLights(const LitSurface& surface, const Vec3& position, Path* path) const;
    CameraLight reflected(const std::vector<Mirror>& mirrors, const Vec3& position, Path* path) const;
    CameraLight seenInMirror(const Ray& ray, Path* path) const;

    Textures textures_;
    RendererSettings settings_;
    SceneGeometry geometry_;
};

}  // namespace glint::oracle

// Lights that paths choose points of, and also find by themselves: emissive triangles, and the sky.
#pragma once

#include "gltf/scene.h"
#include "oracle/irradiance.h"
#include "oracle/scene/geometry.h"

#include <glint/renderer.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace glint::oracle {

// Rec. 709.
inline double luminanceOf(const Vec3& color) {
    return glm::dot(color, Vec3(0.2126, 0.7152, 0.0722));
}

// Chooses points uniformly by area, and triangles by area times the luminance of the emissive factor.
class EmissiveTriangles {
public:
    // Both must outlive the object.
    EmissiveTriangles(const gltf::Scene& scene, const SceneGeometry& geometry);

    bool empty() const {
        return triangles_.empty();
    }
    struct Place {
        std::uint32_t triangle = 0;
        double u = 0.0;  // weights of the second and third corner
        double v = 0.0;
    };
    // Requires that there is a triangle; `point` is uniform in the unit cube.
    Place sample(const Vec3& point) const;
    // Returns the density by area with which sample() chooses a place of a triangle; 0 if it emits nothing.
    double density(std::uint32_t triangle) const;

private:
    std::vector<std::uint32_t> triangles_;
    std::vector<double> sums_;       // of the weights up to a triangle's own
    std::vector<double> densities_;  // by area, of every triangle of the geometry
};

// The sky: a gradient, or an equirectangular map as in shaders/host/sky.glsl, whose texels are filtered
// linearly.
class PathSky {
public:
    explicit PathSky(const GradientSky& gradient) : gradient_(gradient) {}
    // The map must have pixels, none of them negative or not finite.
    explicit PathSky(LinearImage map);

    Vec3 radiance(const Vec3& direction) const;
    // Chooses a direction: uniformly for a gradient; a map by the luminance of its texels, one time in ten
    // uniformly. `point` is uniform in the unit cube.
    Vec3 sample(const Vec3& point) const;
    double density(const Vec3& direction) const;  // by solid angle
    bool black() const;

private:
    Vec3 texel(std::int64_t x, std::int64_t y) const;
    Vec2 coordinates(const Vec3& direction) const;

    GradientSky gradient_;
    std::optional<LinearImage> map_;
    std::vector<double> sums_;  // of the texels' weights up to a texel's own, row by row
};

}  // namespace glint::oracle

// The light that leaves a surface towards the view under a map or lights: by the specification, and as Glint
// says that it approximates the sky.
#pragma once

#include "oracle/spec/bsdf.h"
#include "oracle/spec/map.h"

#include <span>
#include <string>
#include <vector>

namespace glint::spec {

// The light of each lobe.
struct Terms {
    Vec3 specular{0.0};
    Vec3 multiple{0.0};
    Vec3 diffuse{0.0};
    Vec3 diffuseTransmitted{0.0};
    Vec3 transmitted{0.0};
    Vec3 sheen{0.0};
    Vec3 coat{0.0};
    Vec3 emission{0.0};

    Vec3 sum() const;
    Terms& operator+=(const Terms& other);
    Terms operator/(double count) const;
};

// Where a point is and how it is seen. The frame's columns are tangent, bitangent and normal of the mesh.
struct Point {
    glm::dmat3 frame{1.0};
    Vec3 view{0.0, 0.0, 1.0};  // unit, in the world
};

// A directional light.
struct Light {
    Vec3 direction{0.0, 1.0, 0.0};  // unit, towards it, in the world
    Vec3 irradiance{1.0};           // on a surface that faces it
};

// What Glint does for the sky: rays, or the map's means.
enum class Transport : std::uint8_t { Traced, Untraced };

// Integrates with points × 2 points directions a lobe.
struct Quality {
    int points = 96;
};

class Surface {
public:
    // Turns the point's frame by the material's normal textures and its direction of anisotropy.
    Surface(const Material& material, const Choices& choices, Albedos& albedos, const Point& point);
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    // The specification's integral over the map, or its sum over lights.
    Terms underMap(const Map& map, const Quality& quality) const;
    Vec3 underLights(std::span<const Light> lights) const;

    struct Sky {
        const Map& map;
        const Harmonics& harmonics;
        int levels = 5;  // of the map on the device
        Transport transport = Transport::Traced;
        // Rays of the effect indirect diffuse bring the diffuse light, instead of harmonics.
        bool diffuseRays = true;
        double mirrorRoughness = 0.05;
    };
    // The approximations of docs/materials.md and docs/reflections.md, lobe by lobe.
    Terms underSky(const Sky& sky, const Quality& quality) const;

    const Bsdf& bsdf() const {
        return bsdf_;
    }

private:
    glm::dmat3 baseFrame(const Point& point) const;
    Vec3 coatNormal(const Point& point) const;
    Vec3 toWorld(const Vec3& v) const {
        return frame_ * v;
    }
    Vec3 world(const Map& map, const Vec3& l) const {
        return map.at(frame_ * l);
    }
    Vec3 integrateSpecular(const Map& map, int points) const;
    Vec3 integrateCoat(const Map& map, int points) const;
    Vec3 integrateTransmitted(const Map& map, int points) const;
    Vec3 skyBehind(const Sky& sky) const;

    const Material& material_;
    Vec3 meshNormal_;
    glm::dmat3 frame_;  // of the base
    Bsdf bsdf_;
};

}  // namespace glint::spec

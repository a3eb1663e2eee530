// An equirectangular map of radiance, read as docs/reflections.md says that Glint reads one, with the means
// over it that stand in for rays.
#pragma once

#include "oracle/vectors.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace glint::spec {

using oracle::Vec3;

// The first row is up (+Y); the middle of a row is +X and a quarter of a row to its right is +Z.
class Map {
public:
    // Takes the value at the centre of each texel, rounded to a float.
    Map(std::size_t width, std::size_t height, const std::function<Vec3(const Vec3&)>& radiance);

    // Filtered linearly; rows wrap round, columns end at the poles.
    Vec3 at(const Vec3& direction) const;
    std::size_t width() const {
        return width_;
    }
    std::size_t height() const {
        return height_;
    }
    const std::vector<Vec3>& texels() const {
        return texels_;
    }

private:
    std::size_t width_;
    std::size_t height_;
    std::vector<Vec3> texels_;
};

// Irradiance over π from the orders 0 to 2 of spherical harmonics (Ramamoorthi and Hanrahan 2001), cut off at
// 0.
class Harmonics {
public:
    explicit Harmonics(const Map& map);
    Vec3 irradianceOverPi(const Vec3& normal) const;

private:
    std::array<Vec3, 9> coefficients_{};
};

// The mean of the map around a direction over the facets of one roughness that are seen head on, weighted by
// the light's cosine (Karis 2013, "Real Shading in Unreal Engine 4").
Vec3 lobeMean(const Map& map, const Vec3& direction, double roughness);
// The same, mixed between the two nearest of `levels` evenly spaced roughnesses.
Vec3 levelMean(const Map& map, const Vec3& direction, double roughness, int levels);
// The cosine-weighted mean over the hemisphere about a normal: irradiance over π.
Vec3 cosineMean(const Map& map, const Vec3& normal);

}  // namespace glint::spec

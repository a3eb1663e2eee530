#include "oracle/transport/path_lights.h"

#include "oracle/material_vectors.h"

#include <algorithm>

namespace glint::oracle {
namespace {

// Returns the first place whose sum exceeds a share of the whole.
std::size_t placeIn(const std::vector<double>& sums, double share) {
    const auto found = std::upper_bound(sums.begin(), sums.end(), share * sums.back());
    return std::min(static_cast<std::size_t>(found - sums.begin()), sums.size() - 1);
}

double weightAt(const std::vector<double>& sums, std::size_t place) {
    return sums[place] - (place > 0 ? sums[place - 1] : 0.0);
}

constexpr double kUniformShare = 0.1;

Vec3 uniformDirection(double x, double y) {
    const double height = 1.0 - 2.0 * x;
    const double across = std::sqrt(std::max(1.0 - height * height, 0.0));
    return {across * std::cos(2.0 * kPi * y), height, across * std::sin(2.0 * kPi * y)};
}

}  // namespace

EmissiveTriangles::EmissiveTriangles(const gltf::Scene& scene, const SceneGeometry& geometry)
    : densities_(geometry.triangleCount(), 0.0) {
    std::vector<double> areas;
    double total = 0.0;
    for (std::uint32_t i = 0; i < geometry.triangleCount(); ++i) {
        const Triangle& triangle = geometry.triangle(i);
        const materials::Material& material = scene.materials[static_cast<std::size_t>(triangle.material)];
        const double emitted = luminanceOf(toVec(material["emissiveFactor"])) *
                               static_cast<double>(material["emissiveStrength"]);
        const double area = 0.5 * glm::length(glm::cross(triangle.positions[1] - triangle.positions[0],
                                                         triangle.positions[2] - triangle.positions[0]));
        if (emitted > 0.0 && area > 0.0 && !material.isUnlit()) {
            total += emitted * area;
            triangles_.push_back(i);
            sums_.push_back(total);
            densities_[i] = emitted;
        }
    }
    for (const std::uint32_t i : triangles_) {
        densities_[i] /= total;
    }
}

EmissiveTriangles::Place EmissiveTriangles::sample(const Vec3& point) const {
    // Turk, "Generating Random Points in Triangles" (Graphics Gems, 1990).
    const double root = std::sqrt(point.y);
    return {triangles_[placeIn(sums_, point.x)], root * (1.0 - point.z), root * point.z};
}

double EmissiveTriangles::density(std::uint32_t triangle) const {
    return densities_[triangle];
}

PathSky::PathSky(LinearImage map) : map_(std::move(map)) {
    double total = 0.0;
    for (std::int64_t y = 0; y < map_->height; ++y) {
        const double sine = std::sin(kPi * (static_cast<double>(y) + 0.5) / map_->height);
        for (std::int64_t x = 0; x < map_->width; ++x) {
            // What filtering spreads from a texel's neighbours is light, too.
            double light = 0.0;
            for (int dy = -1; dy <= 1; ++dy) {
                for (int dx = -1; dx <= 1; ++dx) {
                    light += luminanceOf(texel(x + dx, y + dy));
                }
            }
            total += light * sine;
            sums_.push_back(total);
        }
    }
}

Vec3 PathSky::texel(std::int64_t x, std::int64_t y) const {
    const std::int64_t width = map_->width;
    const std::int64_t column = ((x % width) + width) % width;
    const std::int64_t row = std::clamp<std::int64_t>(y, 0, std::int64_t{map_->height} - 1);
    const auto& pixel = map_->pixels[static_cast<std::size_t>(row * width + column)];
    return {pixel[0], pixel[1], pixel[2]};
}

Vec2 PathSky::coordinates(const Vec3& direction) const {
    const double across = std::hypot(direction.x, direction.z);
    const double azimuth = across > 0.0 ? std::atan2(direction.z, direction.x) : 0.0;
    return {azimuth / (2.0 * kPi) + 0.5, std::atan2(across, direction.y) / kPi};
}

Vec3 PathSky::radiance(const Vec3& direction) const {
    if (!map_) {
        return gradient_(direction);
    }
    const Vec2 place = coordinates(direction) * Vec2(map_->width, map_->height) - 0.5;
    const Vec2 corner = glm::floor(place);
    const Vec2 share = place - corner;
    const auto x = static_cast<std::int64_t>(corner.x);
    const auto y = static_cast<std::int64_t>(corner.y);
    return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), share.x),
                    glm::mix(texel(x, y + 1), texel(x + 1, y + 1), share.x), share.y);
}

bool PathSky::black() const {
    return map_ ? sums_.back() <= 0.0
                : gradient_.zenith == Vec3(0.0) && gradient_.horizon == Vec3(0.0) &&
                      gradient_.ground == Vec3(0.0);
}

Vec3 PathSky::sample(const Vec3& point) const {
    if (!map_ || point.x < kUniformShare) {
        return uniformDirection(point.y, point.z);
    }
    const std::size_t place = placeIn(sums_, (point.x - kUniformShare) / (1.0 - kUniformShare));
    const double v = (static_cast<double>(place / map_->width) + point.z) / map_->height;
    const double u = (static_cast<double>(place % map_->width) + point.y) / map_->width;
    const double azimuth = 2.0 * kPi * (u - 0.5);
    const double sine = std::sin(kPi * v);
    return {sine * std::cos(azimuth), std::cos(kPi * v), sine * std::sin(azimuth)};
}

double PathSky::density(const Vec3& direction) const {
    constexpr double kUniform = 1.0 / (4.0 * kPi);
    if (!map_) {
        return kUniform;
    }
    const Vec2 uv = coordinates(direction);
    const auto x =
        std::min<std::size_t>(static_cast<std::size_t>(std::max(uv.x, 0.0) * map_->width), map_->width - 1);
    const auto y = std::min<std::size_t>(static_cast<std::size_t>(uv.y * map_->height), map_->height - 1);
    const double sine = std::max(std::hypot(direction.x, direction.z), 1e-12);
    const double texels = static_cast<double>(map_->width) * map_->height;
    const double byMap =
        weightAt(sums_, y * map_->width + x) / sums_.back() * texels / (2.0 * kPi * kPi * sine);
    return kUniformShare * kUniform + (1.0 - kUniformShare) * byMap;
}

}  // namespace glint::oracle

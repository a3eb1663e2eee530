#include "oracle/spec/directions.h"

#include "oracle/spec/lobes.h"

#include <algorithm>
#include <cmath>

namespace glint::spec {

Vec3 polarDirection(double cosine, double azimuth) {
    const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

Direction cosineDirection(const Vec2& point) {
    const double sine = std::sqrt(point.x);
    const double phi = 2.0 * kPi * point.y;
    const double cosine = std::sqrt(1.0 - point.x);
    return {{sine * std::cos(phi), sine * std::sin(phi), cosine}, kPi / cosine};
}

Vec3 visibleNormal(const Vec3& v, const Vec2& alpha, const Vec2& point) {
    // In the space where the microsurface is a hemisphere, visible normals are a projected disk: half of it
    // as it is, half of it foreshortened.
    const Vec3 s = glm::normalize(Vec3(alpha.x * v.x, alpha.y * v.y, v.z));
    const double across = std::hypot(s.x, s.y);
    const Vec3 t1 = across > 1e-12 ? Vec3(-s.y / across, s.x / across, 0.0) : Vec3(1.0, 0.0, 0.0);
    const Vec3 t2 = glm::cross(s, t1);
    const double radius = std::sqrt(point.x);
    const double phi = 2.0 * kPi * point.y;
    const double p1 = radius * std::cos(phi);
    const double p2 =
        std::lerp(std::sqrt(std::max(1.0 - p1 * p1, 0.0)), radius * std::sin(phi), 0.5 * (1.0 + s.z));
    const Vec3 n = p1 * t1 + p2 * t2 + std::sqrt(std::max(1.0 - p1 * p1 - p2 * p2, 0.0)) * s;
    return glm::normalize(Vec3(alpha.x * n.x, alpha.y * n.y, std::max(n.z, 0.0)));
}

double visibleNormalDensity(const Vec3& v, const Vec3& h, const Vec2& alpha) {
    return masking(v, alpha) * distribution(h, alpha) * std::max(glm::dot(v, h), 0.0) / v.z;
}

namespace {

// Moves points towards the edge of the disk of visible normals: facets that are seen from the side, which
// lose the light, lie within alpha² of it. `factor` is the area of the disk for that of the square.
Vec2 towardsEdge(const Vec2& point, double& factor) {
    const double rest = 1.0 - point.x;
    factor = 3.0 * rest * rest;
    return {1.0 - rest * rest * rest, point.y};
}

}  // namespace

Direction reflectedDirection(const Vec3& v, const Vec2& alpha, const Vec2& point) {
    double factor = 0.0;
    const Vec3 h = visibleNormal(v, alpha, towardsEdge(point, factor));
    const double cosine = glm::dot(v, h);
    const double density = visibleNormalDensity(v, h, alpha);
    if (!(density > 0.0)) {
        return {};
    }
    return {glm::normalize(2.0 * cosine * h - v), factor * 4.0 * cosine / density};
}

Direction refractedDirection(const Vec3& v, const Vec2& alpha, double eta, const Vec2& point) {
    double factor = 0.0;
    const Vec3 h = visibleNormal(v, alpha, towardsEdge(point, factor));
    const double cosine = glm::dot(v, h);
    const double density = visibleNormalDensity(v, h, alpha);
    const double refracted2 = 1.0 - (1.0 - cosine * cosine) / (eta * eta);
    if (!(density > 0.0) || refracted2 <= 0.0) {
        return {};
    }
    const Vec3 l = glm::normalize((cosine / eta - std::sqrt(refracted2)) * h - v / eta);
    // Walter et al. 2007, equation 17: the solid angle of h is that of l times this.
    const double lh = std::abs(glm::dot(l, h));
    const double jacobian = eta * eta * lh / squared(glm::dot(v, h) - eta * lh);
    return {l, factor / (density * jacobian)};
}

}  // namespace glint::spec

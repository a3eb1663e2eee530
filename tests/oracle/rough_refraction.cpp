#include "oracle/refraction.h"

namespace glint::oracle {
namespace {

// Returns a visible normal for a uniform point: Heitz, "Sampling the GGX Distribution of Visible Normals"
// (2018), listing 1. Requires view.z > 0.
Vec3 visibleNormal(const Vec3& view, double alpha, Vec2 point) {
    const Vec3 stretched = glm::normalize(Vec3(alpha * view.x, alpha * view.y, view.z));
    const glm::dmat3 frame = frameAbout(stretched);
    // The half of the disk that faces away from the pole is squeezed, along the tangent that rises.
    const Vec3 up(0.0, 0.0, 1.0);
    const Vec3 level = glm::cross(up, stretched);
    const Vec3 across = glm::length(level) > 1e-12 ? glm::normalize(level) : frame[0];
    const Vec3 rising = glm::cross(stretched, across);
    const double radius = std::sqrt(point.x);
    const double x = radius * std::cos(2.0 * kPi * point.y);
    const double half = 0.5 * (1.0 + stretched.z);
    const double y = (1.0 - half) * std::sqrt(1.0 - x * x) + half * radius * std::sin(2.0 * kPi * point.y);
    const Vec3 normal = x * across + y * rising + std::sqrt(std::max(0.0, 1.0 - x * x - y * y)) * stretched;
    return glm::normalize(Vec3(alpha * normal.x, alpha * normal.y, std::max(normal.z, 1e-12)));
}

// Smith's Λ of GGX: (sqrt(1 + α² tan²θ) - 1) / 2.
double lambda(const Vec3& v, double alpha) {
    const double tangent2 = (squared(v.x) + squared(v.y)) / squared(v.z);
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * tangent2) - 1.0);
}

}  // namespace

Estimate roughlyRefractedLight(const World& world, const Ray& ray, const Hit& hit, double alpha,
                               const Dielectric& dielectric, Fresnel fresnel, const HitRadiance& hitRadiance,
                               const SkyRadiance& sky, const Strata& strata, Random& random) {
    const glm::dmat3 frame = frameAbout(hit.normal);
    const Vec3 view = glm::transpose(frame) * -ray.direction;
    return average(strata, random, [&](Vec2 point) {
        const Vec3 facet = visibleNormal(view, alpha, point);
        Vec3 result(0.0);
        for (int channel = 0; channel < 3; ++channel) {
            const double ior = dielectric.ior[channel];
            Vec3 inward;
            if (!refracted(-view, facet, 1.0, ior, inward) || inward.z >= 0.0) {
                continue;
            }
            const double passes =
                1.0 - reflectance(fresnel, 1.0, ior, glm::dot(view, facet), dielectric.schlickIor);
            const double up = 1.0 + lambda(view, alpha);
            const double masking = up / (up + lambda(inward, alpha));
            const Ray onwards{hit.position, frame * inward};
            const std::optional<Hit> found = world.closest(onwards, Faces::All);
            const double light = found ? std::exp(-dielectric.absorption[channel] * found->distance) *
                                             hitRadiance(*found, onwards)[channel]
                                       : sky(onwards.direction)[channel];
            result[channel] = passes * masking * light;
        }
        return result;
    });
}

}  // namespace glint::oracle
